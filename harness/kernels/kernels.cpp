// kernels: the inner pieces of a step, timed one by one by Google Benchmark, so that the cost of a
// step can be explained from its parts. Names: piece/solver/scene:n. Matrices are those of a cloth
// in mid-drape (above 150 vertices a side soon after its start) and a chain in mid-swing, at the
// positions that a filter gets. Items are constrained edges, or vertices. collision_pass and the
// solves include a copy of their input, a few percent.
// floor/...: what the core can do at best. floor_ratio holds a pass of strain limiting over all
// edges against the square root and the division that an edge costs at least; of_peak and
// of_bandwidth hold flops of a factorization against the peak, and bytes of the factor, read twice
// by a solve, against the bandwidth at which an array of the factor's size is read (the library
// prints such ratios with "/s" behind them).
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/errors.h"
#include "harness/base/timing_lock.h"
#include "harness/kernels/floors.h"
#include "harness/kernels/kernel.h"
#include "harness/points/context.h"
#include "solvers/problem/forces.h"
#include "solvers/registry.h"

namespace harness::kernels {

using namespace inextensible;

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

void per_item(benchmark::State& state, int items, const char* what) {
  using benchmark::Counter;
  state.SetItemsProcessed(state.iterations() * items);
  state.counters[what] = Counter(items, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

namespace {

void register_all() {
  const std::vector<std::string> spd{"cholmod_simplicial", "cholmod_supernodal", "multifrontal",
                                     "multifrontal_mixed", "line_cg"};
  register_floors();
  for (const int n : {80, 1000, 100000, 1000000}) {
    register_steps("chain", n);
    register_linear_systems("chain", n, {"tridiagonal"}, {});
  }
  for (const int n : {15, 31, 71, 101}) {
    register_steps("drape", n);
    register_linear_systems("drape", n, spd, {"projected_cg", "quasi_definite"});
  }
  for (const int n : {15, 31, 71, 101, 201, 501}) register_whole_systems(n, spd);
}

}  // namespace
}  // namespace harness::kernels

int main(int argc, char** argv) try {
  harness::use_one_thread();
  // An option of all programs that take times, which Google Benchmark does not know.
  char** const end = std::remove_if(
      argv + 1, argv + argc, [](const char* word) { return std::string(word) == "--no-wait"; });
  const bool wait = end == argv + argc;
  argc = static_cast<int>(end - argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  harness::kernels::register_all();
  const harness::TimingLock lock(wait);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
} catch (const harness::UsageError& error) {
  std::fprintf(stderr, "kernels: %s\n", error.what());
  return 2;
}
