#include "harness/judge/reference.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "harness/base/text.h"
#include "harness/judge/measures.h"
#include "harness/judge/reference_file.h"
#include "harness/points/measures.h"
#include "inextensible/problem/forces.h"

namespace harness {

using inextensible::Positions;
using nlohmann::json;

namespace {

// Area covered by triangles seen from above: pixel centres of a raster, over size^2.
double shadow_area(const Scene& scene, const Positions& x) {
  constexpr int pixels = 512;
  const double reach = 0.75 * scene.size;  // a square cloth of side 1 reaches 0.71 from its middle
  const double pixel = 2 * reach / pixels;
  std::vector<char> dark(pixels * pixels, 0);
  const auto index = [&](double coordinate) {
    return std::clamp(static_cast<int>((coordinate + reach) / pixel), 0, pixels - 1);
  };
  for (const auto& [a, b, c] : scene.triangles) {
    const Eigen::Vector2d p(x(0, a), x(2, a)), q(x(0, b), x(2, b)), r(x(0, c), x(2, c));
    const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
      return u.x() * v.y() - u.y() * v.x();
    };
    const double area = cross(q - p, r - p);
    if (area == 0) continue;
    const Eigen::Vector2d low = p.cwiseMin(q).cwiseMin(r), high = p.cwiseMax(q).cwiseMax(r);
    for (int j = index(low.y()); j <= index(high.y()); ++j) {
      for (int i = index(low.x()); i <= index(high.x()); ++i) {
        const Eigen::Vector2d s((i + 0.5) * pixel - reach, (j + 0.5) * pixel - reach);
        if (cross(q - p, s - p) / area >= 0 && cross(r - q, s - q) / area >= 0 &&
            cross(p - r, s - r) / area >= 0)
          dark[j * pixels + i] = 1;
      }
    }
  }
  const auto count = std::count(dark.begin(), dark.end(), 1);
  return static_cast<double>(count) * pixel * pixel / (scene.size * scene.size);
}

}  // namespace

ShapeStatistics shape_statistics(const Scene& scene, const Positions& x) {
  ShapeStatistics shape;
  shape.potential_energy = inextensible::potential_energy(*scene.problem, x) / energy_scale(scene);
  for (const int corner : scene.corners)
    shape.corner_height += x(1, corner) / scene.size / static_cast<double>(scene.corners.size());
  if (!scene.triangles.empty()) shape.shadow = shadow_area(scene, x);
  return shape;
}

double rms_distance(const Scene& scene, const Positions& x, const Positions& y) {
  double sum = 0;  // term by term, so that equal runs have equal errors to the last digit
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    sum += scene.problem->mass()[i] * (x.col(i) - y.col(i)).squaredNorm();
  return std::sqrt(sum / scene.problem->total_mass()) / scene.size;
}

double max_distance(const Scene& scene, const Positions& x, const Positions& y) {
  return std::sqrt((x - y).colwise().squaredNorm().maxCoeff()) / scene.size;
}

double expected_order(const SceneType* scene) { return scene && scene->pendulum ? 2 : 1; }

std::vector<double> sample_times(double duration) {
  std::vector<double> times;
  for (int k = 1; k * sample_interval <= duration * (1 + 1e-9); ++k)
    times.push_back(k * sample_interval);
  return times;
}

std::string Reference::name() const { return exact ? "exact" : reference_name(scene, parameters); }

int Reference::samples_at(double level) const {
  int count = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) count += sure_gaps * gap[i] <= level ? 1 : 0;
  return count;
}

std::shared_ptr<const Reference> exact_reference(const std::string& scene_name,
                                                 const SceneParameters& complete) {
  const auto found_type = find_scene(scene_name);
  const SceneType& type = *found_type;
  if (!type.exact) return nullptr;
  const auto r = std::make_shared<Reference>();
  r->scene = scene_name;
  r->parameters = complete;
  r->method = r->second_method = "exact";
  r->exact = true;
  r->times = sample_times(complete.at("duration"));
  for (const double time : r->times) r->positions.push_back(type.exact(complete, time));
  r->gap.assign(r->times.size(), 0);
  r->gap_max = r->gap;
  r->valid_until = r->duration();
  r->observed_order = unknown;
  return r;
}

std::shared_ptr<const Reference> ReferenceShelf::find(const std::string& scene,
                                                      const SceneParameters& complete) {
  const std::string name = reference_name(scene, complete);
  const std::string key = name + " " + number_text(complete.at("duration"));
  auto [place, fresh] = known_.try_emplace(key, nullptr);
  if (fresh) place->second = exact_reference(scene, complete);
  if (fresh && !place->second) {
    const std::filesystem::path path = std::filesystem::path(folder_) / name;
    if (std::filesystem::exists(path)) {
      auto stored = std::make_shared<const Reference>(read_reference(path.string()));
      // A file from before a parameter, or its default, was what it is now is another motion's.
      if (stored->name() == name) place->second = std::move(stored);
    }
  }
  return place->second;
}

json ReferenceShelf::summaries() const {
  json list = json::array();
  for (const auto& [name, reference] : known_)
    if (reference) list.push_back(summary_of(*reference));
  return list;
}

}  // namespace harness
