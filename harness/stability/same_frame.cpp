#include <cmath>
#include <random>

#include "harness/base/text.h"
#include "harness/judge/mechanics.h"
#include "harness/stability/cases.h"
#include "harness/stability/stability.h"
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

// Velocities of both belong to one instant: the methods that are compared share that.
ShapeStatistics shape_of(const Scene& scene, const State& state) {
  ShapeStatistics shape = shape_statistics(scene, state.x);
  shape.kinetic_energy =
      inextensible::kinetic_energy(*scene.problem, state.v) / energy_scale(scene);
  return shape;
}

void add_distance(const Scene& scene, const State& a, const State& b, FrameSeries& series) {
  series["rms"].push_back(rms_distance(scene, a.x, b.x));
  series["largest"].push_back(max_distance(scene, a.x, b.x));
  const ShapeStatistics one = shape_of(scene, a), other = shape_of(scene, b);
  for (const auto& [name, member] : shape_statistic_infos)
    series[name].push_back(std::abs(one.*member - other.*member));
}

// The ensemble's standard deviations at a time; unknown between its sample times.
void add_deviation(const Reference* reference, double time, FrameSeries& series) {
  ShapeStatistics found{unknown, unknown, unknown, unknown};
  for (std::size_t i = 0; reference && i < reference->ensemble.deviation.size(); ++i) {
    if (std::abs(reference->times[i] - time) < at_sample) found = reference->ensemble.deviation[i];
  }
  for (const auto& [name, member] : shape_statistic_infos) series[name].push_back(found.*member);
}

bool at_sample_time(double time) {
  return std::abs(time - std::round(time / sample_interval) * sample_interval) < at_sample;
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
  const auto type = find_scene(wanted.scene);
  const auto parameters = complete_parameters(*type, {{"n", wanted.side}});
  const Scene scene = type->build(parameters);
  const auto reference = references.find(wanted.scene, parameters);
  SameFrame found;
  found.scene = wanted;
  struct Run {
    const char* solver;
    std::unique_ptr<Stepper> stepper;
    State state;
  };
  std::vector<Run> runs;
  for (const char* solver : {"fast_projection", "icd", "fast_projection"})
    runs.push_back(
        {solver, inextensible::make_stepper(solver, scene.problem, {wanted.strain_limit, seed, {}}),
         scene.start});
  std::mt19937_64 random(seed);
  cases::add_noise(runs[2].state.x, scene.problem->pinned(), wanted.moved * scene.size, random);
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
    add_distance(scene, runs[0].state, runs[1].state, found.icd);
    add_distance(scene, runs[0].state, runs[2].state, found.moved);
    add_deviation(reference.get(), time, found.deviation);
  }
  return found;
}

}  // namespace harness
