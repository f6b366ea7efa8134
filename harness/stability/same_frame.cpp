#include "harness/stability/same_frame.h"

#include <array>
#include <cmath>
#include <random>

#include "harness/base/text.h"
#include "harness/judge/mechanics.h"
#include "harness/stability/case_parts.h"
#include "solvers/problem/forces.h"
#include "solvers/registry.h"

namespace harness {
namespace {

using inextensible::State;
using inextensible::Stepper;

// Every step until shortly after first contact, which is early, then at the sample times of
// references.
constexpr double densely_until = 0.05;  // s
constexpr double at_sample = 1e-9;      // s

ShapeStatistics apart(const ShapeStatistics& a, const ShapeStatistics& b) {
  ShapeStatistics difference;
  for (const auto& [name, member] : shape_statistic_infos)
    difference.*member = std::abs(a.*member - b.*member);
  return difference;
}

// Velocities of both belong to one instant: the methods that are compared share that.
ShapeStatistics shape_of(const Scene& scene, const State& state) {
  ShapeStatistics shape = shape_statistics(scene, state.x);
  shape.kinetic_energy =
      inextensible::kinetic_energy(*scene.problem, state.v) / energy_scale(scene);
  return shape;
}

// The ensemble's standard deviations at a time; unknown between its sample times.
ShapeStatistics deviation_at(const Reference* reference, double time) {
  for (std::size_t i = 0; reference && i < reference->ensemble.deviation.size(); ++i) {
    if (std::abs(reference->times[i] - time) < at_sample) return reference->ensemble.deviation[i];
  }
  return {unknown, unknown, unknown, unknown};
}

bool at_sample_time(double time) {
  return std::abs(time - std::round(time / sample_interval) * sample_interval) < at_sample;
}

FrameDistance distance(const Scene& scene, const State& a, const State& b) {
  return {rms_distance(scene, a.x, b.x), max_distance(scene, a.x, b.x),
          apart(shape_of(scene, a), shape_of(scene, b))};
}

}  // namespace

std::string SameFrameScene::name() const {
  return scene + " " + std::to_string(side) + " x " + std::to_string(side) + ", strain limit " +
         number_text(strain_limit);
}

std::vector<SameFrameScene> same_frame_scenes() {
  std::vector<SameFrameScene> scenes;
  for (const double limit : {0.01, 0.001}) {
    for (const int side : {21, 31}) scenes.push_back({"drape", side, limit, 1.0 / 200, 1e-10});
    scenes.push_back({"patch", 21, limit, 1.0 / 200, 1e-10});
  }
  return scenes;
}

SameFrame same_frame(const SameFrameScene& wanted, std::uint64_t seed,
                     ReferenceFolder& references) {
  const Scene scene = case_parts::scene_of(wanted.scene.c_str(), {{"n", wanted.side}});
  const auto reference = references.find(
      wanted.scene,
      complete_parameters(*find_scene(wanted.scene), {{"n", static_cast<double>(wanted.side)}}));
  SameFrame found;
  found.scene = wanted;
  struct Run {
    const char* solver;
    std::unique_ptr<Stepper> stepper;
    State state;
  };
  std::array<Run, 3> runs;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    Run& run = runs[i];
    run.solver = i == 1 ? "icd" : "fast_projection";
    run.stepper =
        inextensible::make_stepper(run.solver, scene.problem, {wanted.strain_limit, seed, {}});
    run.state = scene.start;
  }
  std::mt19937_64 random(seed);
  case_parts::add_noise(runs[2].state.x, scene.problem->pinned(), wanted.moved * scene.size,
                        random);
  const long steps = std::lround(scene.duration / wanted.step);
  for (long i = 1; i <= steps; ++i) {
    for (Run& run : runs) {
      const auto result = run.stepper->advance(run.state, wanted.step);
      if (result) continue;
      found.stopped = std::string(run.solver) + " at step " + std::to_string(i) + ": " +
                      to_string(result.status) + ", " + result.detail;
      return found;
    }
    const double time = static_cast<double>(i) * wanted.step;
    if (std::isnan(found.first_contact) && runs[0].stepper->work().contacts > 0)
      found.first_contact = time;
    if (time > densely_until && !at_sample_time(time)) continue;
    found.times.push_back(time);
    found.icd.push_back(distance(scene, runs[0].state, runs[1].state));
    found.moved.push_back(distance(scene, runs[0].state, runs[2].state));
    found.deviation.push_back(deviation_at(reference.get(), time));
  }
  return found;
}

}  // namespace harness
