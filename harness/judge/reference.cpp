#include "harness/judge/reference.h"

#include <cmath>
#include <filesystem>

#include "harness/base/text.h"
#include "harness/judge/reference_file.h"
#include "harness/points/measures.h"

namespace harness {

using inextensible::Positions;
using nlohmann::json;

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

namespace {

// Durations differ where names do not.
std::string shelf_key(const std::string& name, const SceneParameters& complete) {
  return name + " " + number_text(complete.at("duration"));
}

}  // namespace

std::shared_ptr<const Reference> ReferenceFolder::find(const std::string& scene,
                                                       const SceneParameters& complete) {
  const std::string name = reference_name(scene, complete);
  auto [place, fresh] = known_.try_emplace(shelf_key(name, complete), nullptr);
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

void ReferenceFolder::put(std::shared_ptr<const Reference> reference) {
  const std::string key = shelf_key(reference->name(), reference->parameters);
  known_[key] = std::move(reference);
}

json ReferenceFolder::summaries() const {
  json list = json::array();
  for (const auto& [name, reference] : known_)
    if (reference) list.push_back(summary_of(*reference));
  return list;
}

}  // namespace harness
