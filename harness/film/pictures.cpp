#include <atomic>
#include <future>
#include <mutex>
#include <numbers>
#include <numeric>
#include <set>
#include <thread>

#include "harness/base/clock.h"
#include "harness/base/files.h"
#include "harness/film/film.h"
#include "harness/judge/mechanics.h"

namespace harness {

using Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

namespace {

constexpr int legend_end = 4;       // strain over its limit
constexpr double line_spacing = 7;  // pixels between yarns, below which their lines are fainter

// Cloth's own colour up to the limit, warm beyond it; linear. `over_limit`: strain over its limit.
Eigen::Vector3d strain_colour(double over_limit) {
  // Four times the limit is as red as it gets.
  static const std::vector<std::pair<double, Eigen::Vector3d>> stops{
      {0, {0.80, 0.78, 0.72}},   {0.5, {0.58, 0.70, 0.80}}, {1, {0.25, 0.50, 0.75}},
      {1.5, {0.95, 0.70, 0.25}}, {4, {0.80, 0.12, 0.10}},
  };
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const auto& [low, from] = stops[i - 1];
    const auto& [high, to] = stops[i];
    if (over_limit < high)
      return linear(from + std::max(0.0, over_limit - low) / (high - low) * (to - from));
  }
  return linear(stops.back().second);
}

// Colour of each vertex, by the largest strain of its edges.
Eigen::Matrix3Xd colours_of(const Problem& problem, const Positions& x, double limit) {
  std::vector<double> strains, most(static_cast<std::size_t>(x.cols()), 0);
  append_strains(problem, x, strains);
  for (std::size_t k = 0; k < strains.size(); ++k) {
    const auto [a, b] = problem.edges()[k];
    for (const int end : {a, b}) most[end] = std::max(most[end], strains[k]);
  }
  Eigen::Matrix3Xd colours(3, x.cols());
  for (Eigen::Index v = 0; v < x.cols(); ++v) colours.col(v) = strain_colour(most[v] / limit);
  return colours;
}

std::vector<std::uint8_t> yarns_of(const Scene& scene) {
  std::set<std::pair<int, int>> edges;
  for (const auto& [a, b] : scene.problem->edges()) edges.insert(std::minmax(a, b));
  std::vector<std::uint8_t> sides;
  sides.reserve(scene.triangles.size());
  for (const auto& t : scene.triangles) {
    unsigned yarns = 0;
    for (unsigned k = 0; k < 3; ++k)
      if (edges.contains(std::minmax(t[k], t[(k + 1) % 3]))) yarns |= 1U << k;
    sides.push_back(static_cast<std::uint8_t>(yarns));
  }
  return sides;
}

// Sag of each mark at each frame below where it would hang if nothing stretched, m.
json sags(const Scene& scene, const FilmRun& take) {
  json all = json::object();
  for (const Scene::Mark& mark : scene.marks) {
    json& sag = all[mark.name] = json::array();
    for (const auto& frame : take.frames) sag.push_back(mark.height - frame(1, mark.vertex));
  }
  return all;
}

std::string ppm(const Pixels& pixels) {
  return "P6\n" + std::to_string(pixels.width) + " " + std::to_string(pixels.height) + "\n255\n" +
         std::string(pixels.rgb.begin(), pixels.rgb.end());
}

// Calls work(0) to work(count - 1) on all cores. Rethrows what one of them threw.
void on_all_cores(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  const auto loop = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::future<void>> others;
  for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i)
    others.push_back(std::async(std::launch::async, loop));
  loop();
  for (std::future<void>& other : others) other.get();
}

constexpr double half_angle = 12 * std::numbers::pi / 180;
constexpr double margin = 1.06;
// Distance up to which cloth stays in view, over the radius of the start: with a body, and without.
constexpr double near_body = 1.1, near_start = 3;

std::vector<Vector3d> in_sight(const Recording& recording, const std::vector<std::size_t>& frames) {
  const Positions& start = recording.takes.at(0).frames.at(0);
  const Box cloth(start.rowwise().minCoeff(), start.rowwise().maxCoeff());
  std::vector<Eigen::Index> near;  // corners of the body; not those of a floor
  const Positions whole_body = body_at(recording, 0);
  for (Eigen::Index i = 0; i < whole_body.cols(); ++i)
    if ((whole_body.col(i) - cloth.center()).norm() < 4 * cloth.diagonal().norm())
      near.push_back(i);
  const bool body = !near.empty();
  const Positions body_start = body ? Positions(whole_body(Eigen::all, near)) : start;
  const Vector3d at_first =
      Box(body_start.rowwise().minCoeff(), body_start.rowwise().maxCoeff()).center();
  double reach = 0;
  for (const Positions* x : {&start, &body_start})
    reach = std::max(reach, (x->colwise() - at_first).colwise().norm().maxCoeff());
  const double followed = (body ? near_body : near_start) * reach;
  std::vector<Vector3d> all;
  for (const FilmRun& take : recording.takes) {
    for (const std::size_t shown : frames) {
      const std::size_t frame = std::min(shown, take.frames.size() - 1);
      Vector3d middle = at_first;
      if (!recording.body_poses.empty())
        middle = recording.body_poses.at(frame)(recording.body_poses[0].inverse()(middle));
      for (const auto& point : take.frames[frame].colwise())
        if ((point - middle).norm() <= followed) all.emplace_back(point);
      const Positions around = body_at(recording, frame);
      for (const Eigen::Index i : near) all.emplace_back(around.col(i));
    }
  }
  return all;
}

}  // namespace

Shot shot_of(const Recording& recording, const View& view, std::size_t take, std::size_t frame,
             int width) {
  const FilmRun& shown = recording.takes.at(take);
  Shot shot{.recording = recording, .cloth = shown.frames.at(frame)};
  shot.colours = colours_of(*recording.scene.problem, shot.cloth, shown.strain_limit);
  if (!recording.body.vertices.empty()) shot.body = body_at(recording, frame);
  const std::vector<double>& lengths = recording.scene.problem->rest_length();
  const double edge = std::accumulate(lengths.begin(), lengths.end(), 0.0) /
                      std::max(1.0, static_cast<double>(lengths.size()));  // m, the mean
  const double distance = (view.eye - view.centre).norm();
  const double pixel = 2 * view.tangent * distance / width;  // m
  shot.thickness = std::clamp(0.25 * edge, 0.004 * view.size, 0.03 * view.size);
  if (recording.scene.triangles.empty()) {
    shot.yarn = std::max(1.2 * pixel, std::min(0.009 * view.size, 0.25 * edge));
    return shot;
  }
  shot.yarns = yarns_of(recording.scene);
  shot.yarn = std::clamp(0.05 * edge, 0.4 * pixel, 0.9 * pixel);
  shot.yarn_shade = 0.5 * std::min(1.0, edge / (line_spacing * pixel));
  return shot;
}

void write_pictures(const std::string& folder, const Recording& recording, const PictureSpec& spec,
                    const std::function<void(std::size_t, std::size_t)>& told) {
  const View view = view_of(recording, spec.frames);
  std::set<std::pair<std::size_t, std::size_t>> distinct;  // take and frame
  for (std::size_t take = 0; take < recording.takes.size(); ++take)
    for (const std::size_t frame : spec.frames)
      distinct.emplace(take, std::min(frame, recording.takes[take].frames.size() - 1));
  const std::vector pictures(distinct.begin(), distinct.end());
  std::mutex lock;
  std::size_t done = 0;
  on_all_cores(pictures.size(), [&](std::size_t i) {
    if (interrupted()) throw Interrupted();
    const auto [take, frame] = pictures[i];
    const Shot shot = shot_of(recording, view, take, frame, spec.width);
    const std::string name = std::to_string(take) + "-" + std::to_string(frame) + ".ppm";
    write_atomically(folder + "/" + name, ppm(trace(shot, view, spec.width, spec.samples)));
    const std::lock_guard held(lock);
    told(++done, pictures.size());
  });
  json legend = json::array(), takes = json::array();
  for (int i = 0; i <= 16 * legend_end; ++i) legend.push_back(shade(strain_colour(i / 16.0)));
  for (const FilmRun& take : recording.takes)
    takes.push_back({{"label", take.label},
                     {"strain_limit", take.strain_limit},
                     {"step", take.step},
                     {"detail", take.detail},
                     {"energy_gained", take.energy_gained},
                     {"frames", take.frames.size()},
                     {"largest_strain", take.largest_strain},
                     {"sag", sags(recording.scene, take)},
                     {"seconds", take.seconds}});
  const json header{
      {"width", spec.width},     {"height", view.height(spec.width)},
      {"frames", spec.frames},   {"frames_per_second", recording.spec.frames_per_second},
      {"takes", takes},          {"legend", legend},
      {"legend_end", legend_end}};
  write_atomically(folder + "/film.json", compact(header) + "\n");
}

int View::height(int width) const {
  return std::max(1, static_cast<int>(std::lround(width * aspect)));
}

Vector3d View::ray(double x, double y) const {
  return (tangent * (x * right + y * aspect * up) - towards).normalized();
}

View view_of(const Recording& recording, const std::vector<std::size_t>& frames) {
  const std::vector<Vector3d> all = in_sight(recording, frames);
  Box whole;
  for (const Vector3d& point : all) whole.extend(point);
  const bool in_a_plane = whole.sizes().z() < 1e-3 * whole.sizes().maxCoeff();
  View view;
  view.tangent = std::tan(half_angle);
  view.towards = (in_a_plane ? Vector3d(0, 0.12, 1) : Vector3d(0.55, 0.45, 1)).normalized();
  view.right = Vector3d::UnitY().cross(view.towards).normalized();
  view.up = view.towards.cross(view.right);
  Eigen::Matrix3d axes;
  axes << view.right.transpose(), view.up.transpose(), view.towards.transpose();
  Box box;
  for (const Vector3d& point : all) box.extend(axes * point);
  const Vector3d middle = box.center(), half = (0.5 * box.sizes()).cwiseMax(1e-6);
  view.aspect = std::clamp(half.y() / half.x(), 0.5, 1.3);
  double distance = 0;
  for (const Vector3d& point : all) {
    const Vector3d p = axes * point - middle;
    const double wide = std::max(std::abs(p.x()), std::abs(p.y()) / view.aspect);
    distance = std::max(distance, margin * wide / view.tangent + p.z());
  }
  view.size = std::max(half.x(), half.y());
  view.centre = axes.transpose() * middle;
  view.eye = view.centre + std::max(distance, 1e-6) * view.towards;
  return view;
}

}  // namespace harness
