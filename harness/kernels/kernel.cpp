#include "harness/kernels/kernel.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

#include "solvers/linear/spd_solvers.h"
#include "solvers/problem/forces.h"
#include "solvers/registry.h"

namespace harness::kernels {

using namespace inextensible;
using benchmark::Counter;

const Moment& moment(const std::string& scene, int n) {
  static std::map<std::pair<std::string, int>, Moment> moments;
  const auto [place, is_new] = moments.try_emplace({scene, n});
  Moment& m = place->second;
  if (!is_new) return m;
  const auto found_type = find_scene(scene);
  const SceneType& type = *found_type;
  m.scene = type.build(complete_parameters(type, {{"n", n}}));
  m.h = scene == "drape" ? 0.005 : std::min(0.001, 1.0 / n);
  m.state = m.scene.start;
  const auto stepper = make_stepper("fast_projection", m.scene.problem, {});
  const int wanted = n > (scene == "drape" ? 150 : 200000) ? 4 : 40;
  int steps = 0;
  while (steps < wanted && stepper->advance(m.state, m.h)) ++steps;
  if (steps < wanted)
    std::fprintf(stderr, "kernels: %s:%d: step %d was refused\n", scene.c_str(), n, steps + 1);
  m.x0.resize(3, m.problem().vertices());
  WorkCounters work;
  unconstrained_step(m.problem(), m.state, m.h, m.x0, work);
  return m;
}

Linearized::Linearized(const Moment& m, std::string_view name)
    : system(m.problem(), 0.01, name),
      u(3, m.problem().constraints()),
      c(m.problem().constraints()),
      solver(make_spd_solver(system.solver_name(), system.schur().pattern())) {
  system.edges().linearize(m.x0, u, c);
  system.schur().assemble(u, solver->values());
}

void per_item(benchmark::State& state, int items, const char* what) {
  state.SetItemsProcessed(state.iterations() * items);
  state.counters[what] = Counter(items, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

benchmark::internal::Benchmark* add(const std::string& name, const Body& body) {
  return benchmark::RegisterBenchmark(name.c_str(), body)->Unit(benchmark::kMicrosecond);
}

}  // namespace harness::kernels
