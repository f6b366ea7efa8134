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
#include <string>
#include <vector>

#include "harness/base/errors.h"
#include "harness/base/timing_lock.h"
#include "harness/kernels/kernel.h"
#include "harness/points/context.h"

namespace harness::kernels {
namespace {

void register_chain(int n) {
  const std::string at = "/chain:" + std::to_string(n);
  register_steps("chain", n, at);
  register_schur_complement("chain", n, at, {"tridiagonal"});
  std::vector<std::string> solvers{"fast_projection", "implicit_springs"};
  if (n <= 80) solvers.insert(solvers.end(), {"shake", "rattle", "icd"});
  register_iterations("chain", n, at, solvers);
}

void register_drape(int n) {
  const std::string at = "/drape:" + std::to_string(n);
  register_steps("drape", n, at);
  register_collision("drape", n, at);
  register_strain_passes(n, at);
  register_schur_complement("drape", n, at,
                            {"cholmod_simplicial", "cholmod_supernodal", "multifrontal",
                             "multifrontal_mixed", "line_cg"});
  register_saddle_point(n, at, {"projected_cg", "quasi_definite"});
}

void register_all() {
  register_floors();
  for (const int n : {80, 1000, 100000, 1000000}) register_chain(n);
  for (const int n : {15, 31, 71, 101}) register_drape(n);
  for (const int n : {15, 31, 71, 101, 201, 501})
    register_whole_systems(n, {"cholmod_simplicial", "cholmod_supernodal", "multifrontal",
                               "multifrontal_mixed", "line_cg"});
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
