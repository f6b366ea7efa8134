#include "harness/film/recording.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "harness/base/clock.h"
#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/json_text.h"
#include "harness/base/text.h"
#include "harness/film/orientation.h"
#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/run/measure_point.h"
#include "solvers/problem/triangle_collider.h"
#include "solvers/registry.h"

namespace harness {
namespace {

using inextensible::State;

Stage stage_of(const Scene& scene) {
  Stage stage;
  stage.triangles = oriented(scene.triangles);
  for (const auto [a, b] : scene.problem->edges()) stage.edges.push_back({a, b});
  stage.rest_length = scene.problem->rest_length();
  stage.marks = scene.marks;
  const auto* body = dynamic_cast<const inextensible::TriangleCollider*>(scene.problem->collider());
  if (body) {
    stage.body = body->mesh().vertices;
    stage.body_triangles = body->mesh().triangles;
  }
  return stage;
}

constexpr double strain_unit = 1.0 / 60;  // of a take's limit; colours end at four times that

// The settings given, and for springs the stiffness that a sweep would find.
inextensible::Settings calibrated(const FilmSpec& spec, const Contestant& contestant, double limit,
                                  double step, const std::function<bool()>& interrupted) {
  const inextensible::Backend& backend = *inextensible::find_backend(contestant.solver);
  inextensible::Settings settings = contestant.settings;
  if (backend.knob != inextensible::Knob::stiffness || settings.contains("stiffness"))
    return settings;
  PointSpec point;
  point.sweep = "strain";
  point.scene = spec.scene;
  point.scene_parameters = spec.parameters;
  point.solver = contestant.solver;
  point.settings = settings;
  point.strain_limit = limit;
  point.step = step;
  RunLimits limits;
  limits.timed = false;
  limits.interrupted = interrupted;
  const PointResult found = run_point(point, limits);
  if (found.stiffness) settings["stiffness"] = *found.stiffness;
  return settings;
}

struct Pace {
  double step;  // s
  int steps_per_frame;
  std::size_t frames;
};

Take take_of(const Scene& scene, const Stage& stage, const Contestant& contestant, double limit,
             const inextensible::Settings& settings, const Pace& pace,
             const std::function<bool()>& interrupted,
             const std::function<void(const Take&)>& told) {
  Take take;
  take.solver = contestant.name;
  take.label = label_of(contestant);
  take.strain_limit = limit;
  take.smallest_step = pace.step;
  State state = start_of(scene, *inextensible::find_backend(contestant.solver), pace.step);
  const auto stepper =
      inextensible::make_stepper(contestant.solver, scene.problem, {limit, 1, settings, &state});
  const auto keep = [&](const State& at) {
    take.frames.push_back(at.x);
    const std::vector<double> all = strains(stage, at.x);
    take.largest_strain.push_back(all.empty() ? 0 : *std::max_element(all.begin(), all.end()));
    told(take);
  };
  keep(state);
  auto begin = Clock::now();
  const auto look = [&](const State& at, const Driven& driven) {
    if (!driven.whole || driven.steps % pace.steps_per_frame != 0) return true;
    take.smallest_step = driven.smallest;
    take.seconds.push_back(since(begin));
    keep(at);
    begin = Clock::now();
    return true;
  };
  const long steps = pace.steps_per_frame * (static_cast<long>(pace.frames) - 1);
  const Driven driven = drive(*stepper, state, {pace.step, steps, usual_halvings}, look,
                              {.interrupted = interrupted});
  if (driven.end == Driven::End::refused)
    take.detail = "gave up at t = " + number_text(state.time, 3) + " s: " + driven.result.detail;
  return take;
}

}  // namespace

std::vector<double> strains(const Stage& stage, const inextensible::Positions& x) {
  std::vector<double> all;
  all.reserve(stage.edges.size());
  for (std::size_t k = 0; k < stage.edges.size(); ++k) {
    const auto [a, b] = stage.edges[k];
    all.push_back(strain_size(x, a, b, stage.rest_length[k]));
  }
  return all;
}

std::vector<double> strains_of_vertices(const Stage& stage, const inextensible::Positions& x) {
  std::vector<double> most(static_cast<std::size_t>(x.cols()), 0);
  const std::vector<double> all = strains(stage, x);
  for (std::size_t k = 0; k < all.size(); ++k)
    for (const int end : stage.edges[k]) most[end] = std::max(most[end], all[k]);
  return most;
}

inextensible::Positions body_at(const Stage& stage, std::size_t frame) {
  const inextensible::Pose pose =
      stage.body_poses.empty() ? inextensible::Pose{} : stage.body_poses.at(frame);
  inextensible::Positions x(3, stage.body.size());
  for (std::size_t i = 0; i < stage.body.size(); ++i)
    x.col(static_cast<Eigen::Index>(i)) = pose(stage.body[i]);
  return x;
}

std::size_t frames_in(const FilmSpec& spec) {
  return 1 + static_cast<std::size_t>(
                 std::floor(spec.parameters.at("duration") * spec.frames_per_second + 1e-9));
}

Recording record(const FilmSpec& spec, const std::function<bool()>& interrupted,
                 const std::function<void(const Take&, std::size_t, std::size_t)>& told) {
  const Scene scene = find_scene(spec.scene)->build(spec.parameters);
  Recording recording;
  recording.spec = spec;
  recording.steps_per_frame =
      std::max(1, static_cast<int>(std::ceil(1 / (spec.frames_per_second * spec.step) - 1e-9)));
  recording.step = 1 / (spec.frames_per_second * recording.steps_per_frame);
  recording.stage = stage_of(scene);
  const std::size_t frames = frames_in(spec);
  if (const auto& motion = scene.problem->body_motion()) {
    for (std::size_t i = 0; i < frames; ++i)
      recording.stage.body_poses.push_back(
          motion(scene.start.time + static_cast<double>(i) / spec.frames_per_second));
  }
  for (const double limit : spec.strain_limits) {
    for (const Contestant& contestant : spec.solvers) {
      const auto settings = calibrated(spec, contestant, limit, recording.step, interrupted);
      recording.takes.push_back(
          take_of(scene, recording.stage, contestant, limit, settings,
                  {recording.step, recording.steps_per_frame, frames}, interrupted,
                  [&](const Take& take) { told(take, take.frames.size(), frames); }));
    }
  }
  return recording;
}

namespace {

// Of each mark, at each frame: how far below the height where it would hang if nothing stretched,
// m.
nlohmann::json sags(const Stage& stage, const Take& take) {
  nlohmann::json all = nlohmann::json::object();
  for (const Scene::Mark& mark : stage.marks) {
    nlohmann::json& sag = all[mark.name] = nlohmann::json::array();
    for (const auto& frame : take.frames) sag.push_back(mark.height - frame(1, mark.vertex));
  }
  return all;
}

nlohmann::json film_header(const Recording& recording) {
  nlohmann::json takes = nlohmann::json::array(), body = nlohmann::json::array(),
                 poses = nlohmann::json::array();
  for (const Take& take : recording.takes)
    takes.push_back({{"solver", take.solver},
                     {"label", take.label},
                     {"strain_limit", take.strain_limit},
                     {"detail", take.detail},
                     {"frames", take.frames.size()},
                     {"largest_strain", take.largest_strain},
                     {"sag", sags(recording.stage, take)},
                     {"seconds", take.seconds}});
  for (const Eigen::Vector3d& v : recording.stage.body) body.push_back({v.x(), v.y(), v.z()});
  for (const inextensible::Pose& pose : recording.stage.body_poses) {
    const auto& r = pose.turn;
    poses.push_back({r(0, 0), r(0, 1), r(0, 2), pose.translation[0], r(1, 0), r(1, 1), r(1, 2),
                     pose.translation[1], r(2, 0), r(2, 1), r(2, 2), pose.translation[2]});
  }
  return {{"schema", "inextensible-film/1"},
          {"scene", recording.spec.scene},
          {"scene_parameters", recording.spec.parameters},
          {"step", recording.step},
          {"frames_per_second", recording.spec.frames_per_second},
          {"vertices", recording.takes.empty() ? 0 : recording.takes[0].frames[0].cols()},
          {"triangles", recording.stage.triangles},
          {"edges", recording.stage.edges},
          {"strain_unit", strain_unit},
          {"body", body},
          {"body_triangles", recording.stage.body_triangles},
          {"body_poses", poses},
          {"takes", takes}};
}

std::string film_strains(const Recording& recording) {
  std::string bytes;
  for (const Take& take : recording.takes) {
    for (const inextensible::Positions& frame : take.frames) {
      for (const double strain : strains_of_vertices(recording.stage, frame))
        bytes += static_cast<char>(static_cast<unsigned char>(
            std::min(255.0, std::round(strain / take.strain_limit / strain_unit))));
    }
  }
  return bytes;
}

std::string film_positions(const Recording& recording) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes;
  for (const Take& take : recording.takes) {
    for (const inextensible::Positions& frame : take.frames) {
      const Eigen::Matrix3Xf single = frame.cast<float>();
      bytes.append(reinterpret_cast<const char*>(single.data()),
                   static_cast<std::size_t>(single.size()) * sizeof(float));
    }
  }
  return bytes;
}

}  // namespace

void write_film_header(const std::string& folder, const Recording& recording) {
  write_atomically(folder + "/film.json", compact(film_header(recording)) + "\n");
}

void write_recording(const std::string& folder, const Recording& recording) {
  write_film_header(folder, recording);
  write_atomically(folder + "/film.f32", film_positions(recording));
  write_atomically(folder + "/film.u8", film_strains(recording));
}

}  // namespace harness
