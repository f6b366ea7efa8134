// What the kernels are timed on, and how one is registered.
#pragma once

#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "harness/scenes/scene.h"
#include "solvers/linear/spd_solvers.h"
#include "solvers/systems/constraint_system.h"

namespace harness::kernels {

// A scene after some steps of fast projection: deformed, in contact where there is something to
// touch. Made once: Google Benchmark calls each benchmark several times to find its number of
// iterations.
struct Moment {
  Scene scene;
  double h;  // s
  inextensible::State state;
  inextensible::Positions x0;  // after the next unconstrained step
  const inextensible::Problem& problem() const { return *scene.problem; }
};
const Moment& moment(const std::string& scene, int n);

// "factor/multifrontal/drape:71" is a function of the arguments, on a scene of some size.
template <class Body, class... Arguments>
benchmark::internal::Benchmark* add(const std::string& name, const Body& body,
                                    const Arguments&... arguments) {
  return benchmark::RegisterBenchmark(name.c_str(),
                                      [=](benchmark::State& state) { body(state, arguments...); })
      ->Unit(benchmark::kMicrosecond);
}

inline benchmark::Counter rate(double each) {
  return benchmark::Counter(each, benchmark::Counter::kIsIterationInvariantRate);
}
inline benchmark::Counter average(double all) {
  return benchmark::Counter(all, benchmark::Counter::kAvgIterations);
}
// Items are constrained edges, or vertices.
void per_item(benchmark::State& state, int items, const char* what = "s_per_edge");

void register_steps(const std::string& scene, int n);
void register_linear_systems(const std::string& scene, int n, const std::vector<std::string>& spd,
                             const std::vector<std::string>& saddle_point);
void register_whole_systems(int n, const std::vector<std::string>& solvers);  // of the drape

}  // namespace harness::kernels
