// kernels: the linear solvers' share of a step, timed piece by piece by Google Benchmark. Names:
// piece/solver/scene:n. Matrices J W J^T are those of a cloth in mid-drape and a chain in
// mid-swing, at the positions that a filter gets. Items are constrained edges. Solves include a
// copy of their right-hand side, a few percent. of_peak compares flops of a factorization with
// those of a dense product, of_bandwidth bytes of the factor, read twice by a solve, with the
// bandwidth at which an array of its size is read (the library prints such ratios with "/s" behind
// them).
#include <benchmark/benchmark.h>

#include <bit>
#include <cstdio>

#include "harness/base/clock.h"
#include "harness/base/timing_lock.h"
#include "harness/points/context.h"
#include "harness/scenes/scene.h"
#include "solvers/problem/forces.h"
#include "solvers/registry.h"
#include "solvers/systems/constraint_system.h"

namespace harness::kernels {
namespace {

using namespace inextensible;
using benchmark::Counter;

// ---- What one core of this machine can do at best: the floors that kernels are held against ----

// s of processor time, the shortest of several runs, so that other programs do not count.
template <class Work>
double shortest(int rounds, Work work) {
  double best = HUGE_VAL;
  for (int round = 0; round < rounds; ++round) {
    const double start = thread_seconds();
    work();
    best = std::min(best, thread_seconds() - start);
  }
  return best;
}

// In as many sums as hide how long an addition takes.
void read_all(const Eigen::VectorXd& data) {
  constexpr int sums = 32;
  Eigen::Array<double, sums, 1> sum = Eigen::Array<double, sums, 1>::Zero();
  for (Eigen::Index i = 0; i < data.size(); i += sums) sum += data.segment<sums>(i).array();
  benchmark::DoNotOptimize(sum);
}

// Bytes a second at which an array of that size is read over and over: of the cache that it fits
// into, or of memory. Measured at the first call for a size, to a factor of two.
double read_bandwidth(double bytes) {
  static std::map<std::size_t, double> known;
  const auto size =
      std::bit_ceil(std::max<std::size_t>(128, static_cast<std::size_t>(bytes / sizeof(double))));
  double& rate = known[size];
  if (rate > 0) return rate;
  const Eigen::VectorXd data = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(size));
  const std::size_t passes = std::max<std::size_t>(1, (std::size_t{1} << 21) / size);
  const double seconds = shortest(10, [&] {
    for (std::size_t pass = 0; pass < passes; ++pass) read_all(data);
  });
  return rate = static_cast<double>(passes * size * sizeof(double)) / seconds;
}

// Floating-point operations a second in a product of dense matrices, which comes nearest to the
// peak; a fused multiply-add counts as two. Measured at the first call.
double peak_flops() {
  constexpr int size = 256;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Ones(size, size);
  Eigen::MatrixXd c = a;
  static const double seconds = shortest(20, [&] {
    c.noalias() = a * a;
    benchmark::DoNotOptimize(c.data());
  });
  return 2.0 * size * size * size / seconds;
}

// A scene after some steps of fast projection, and where the next unconstrained step takes it. Made
// once: Google Benchmark calls each benchmark several times.
struct Moment {
  Scene scene;
  Positions x0;
  const Problem& problem() const { return *scene.problem; }
};

const Moment& moment(const std::string& scene, int n) {
  static std::map<std::pair<std::string, int>, Moment> moments;
  const auto [place, is_new] = moments.try_emplace({scene, n});
  Moment& m = place->second;
  if (!is_new) return m;
  m.scene = built_scene(scene, {{"n", n}});
  const double h = scene == "drape" ? 0.005 : std::min(0.001, 1.0 / n);
  State state = m.scene.start;
  const auto stepper = make_stepper("fast_projection", m.scene.problem, {});
  const int wanted = n > 200000 ? 4 : 40;
  int steps = 0;
  while (steps < wanted && stepper->advance(state, h)) ++steps;
  if (steps < wanted)
    std::fprintf(stderr, "kernels: %s:%d: step %d was refused\n", scene.c_str(), n, steps + 1);
  WorkCounters work;
  unconstrained_step(m.problem(), state, h, m.x0, work);
  return m;
}

Counter rate(double each) { return Counter(each, Counter::kIsIterationInvariantRate); }
void per_edge(benchmark::State& state, int edges) {
  state.SetItemsProcessed(state.iterations() * edges);
  state.counters["s_per_edge"] =
      Counter(edges, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

// ---- Assembly, factorization and back-substitution of J W J^T ----

// J W J^T at x0 in the solver's order, not yet factored.
struct Linearized {
  Linearized(const Moment& m, std::string_view name)
      : system(m.problem(), 0.01, name),
        u(3, m.problem().constraints()),
        c(m.problem().constraints()),
        solver(make_spd_solver(system.solver_name(), system.schur().pattern())) {
    system.edges().linearize(m.x0, u, c);
    system.schur().assemble(u, solver->values());
  }
  ConstraintSystem system;
  Eigen::Matrix3Xd u;
  Eigen::VectorXd c;
  std::unique_ptr<SpdSolver> solver;
};

void assembly(benchmark::State& state, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const Linearized l(m, "auto");
  while (state.KeepRunning()) {
    l.system.schur().assemble(l.u, l.solver->values());
    benchmark::ClobberMemory();
  }
  per_edge(state, m.problem().constraints());
  state.counters["entries"] = l.system.schur().pattern().entries();
}

void linear_solver(benchmark::State& state, const std::string& name, bool solve,
                   const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const Linearized l(m, name);
  if (!l.solver->factor()) return state.SkipWithError("not positive definite");
  Eigen::VectorXd x = l.c;
  while (state.KeepRunning()) {
    if (solve) {
      x = l.c;
      l.solver->solve(x.data());
    } else {
      benchmark::DoNotOptimize(l.solver->factor());
    }
    benchmark::ClobberMemory();
  }
  per_edge(state, m.problem().constraints());
  state.counters["nnz_L"] = l.solver->factor_nonzeros();
  if (solve) {
    const double bytes = l.solver->factor_nonzeros() * sizeof(double);
    state.counters["of_bandwidth"] = rate(2 * bytes / read_bandwidth(bytes));
  } else {
    state.counters["flops"] = rate(l.solver->factor_flops());
    state.counters["of_peak"] = rate(l.solver->factor_flops() / peak_flops());
  }
}

template <class Body, class... Arguments>
void add(const std::string& name, const Body& body, const Arguments&... arguments) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    body(state, arguments...);
  })->Unit(benchmark::kMicrosecond);
}

void register_all(const std::string& scene, const std::vector<int>& sizes,
                  const std::vector<std::string>& solvers) {
  for (const int n : sizes) {
    const std::string at = "/" + scene + ":" + std::to_string(n);
    add("assembly" + at, assembly, scene, n);
    for (const std::string& name : solvers) {
      add("factor/" + name + at, linear_solver, name, false, scene, n);
      add("solve/" + name + at, linear_solver, name, true, scene, n);
    }
  }
}

}  // namespace
}  // namespace harness::kernels

int main(int argc, char** argv) try {
  harness::use_one_thread(argv);
  // An option of all programs that time runs, which Google Benchmark does not know.
  char** const end = std::remove_if(
      argv + 1, argv + argc, [](const char* word) { return std::string(word) == "--no-wait"; });
  const bool wait = end == argv + argc;
  argc = static_cast<int>(end - argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  harness::kernels::register_all("chain", {80, 1000, 100000, 1000000}, {"tridiagonal"});
  harness::kernels::register_all("drape", {15, 31, 71, 101},
                                 {"cholmod_supernodal", "multifrontal", "multifrontal_mixed"});
  const harness::TimingLock lock(wait);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
} catch (const harness::UsageError& error) {
  std::fprintf(stderr, "kernels: %s\n", error.what());
  return 2;
}
