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
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "harness/base/errors.h"
#include "harness/base/timing_lock.h"
#include "harness/kernels/hardware_peak.h"
#include "harness/points/context.h"
#include "harness/scenes/scene.h"
#include "inextensible/linear/spd_solvers.h"
#include "inextensible/methods/gauss_seidel.h"
#include "inextensible/methods/gauss_seidel_colored.h"
#include "inextensible/methods/icd.h"
#include "inextensible/methods/jacobi.h"
#include "inextensible/problem/forces.h"
#include "inextensible/registry.h"
#include "inextensible/systems/constraint_system.h"
#include "inextensible/systems/kkt_system.h"
#include "inextensible/systems/projected_cg.h"

namespace {

using namespace inextensible;
using benchmark::Counter;
using harness::processor_seconds;

// A scene after some steps of fast projection: deformed, in contact where there is something to
// touch.
struct Moment {
  harness::Scene scene;
  double h;  // s
  State state;
  Positions x0;  // after the next unconstrained step
  const Problem& problem() const { return *scene.problem; }
};

// Made once: Google Benchmark calls each benchmark several times to find its number of iterations.
const Moment& moment(const std::string& scene, int n) {
  static std::map<std::pair<std::string, int>, Moment> moments;
  const auto [place, is_new] = moments.try_emplace({scene, n});
  Moment& m = place->second;
  if (!is_new) return m;
  const harness::SceneType& type = *harness::find_scene(scene);
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

void per_item(benchmark::State& state, int items, const char* what = "s_per_edge") {
  state.SetItemsProcessed(state.iterations() * items);
  state.counters[what] = Counter(items, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void edge_pass(benchmark::State& state, bool gradients, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const EdgeConstraints edges(m.problem(), 1);  // nothing violates: the whole pass
  if (!edges.permissible(m.x0)) return state.SkipWithError("leaves early");
  Eigen::Matrix3Xd u(3, edges.count());
  Eigen::VectorXd c(edges.count());
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(gradients ? edges.linearize(m.x0, u, c) : edges.permissible(m.x0));
    benchmark::ClobberMemory();
  }
  per_item(state, edges.count());
}

void assembly(benchmark::State& state, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const Linearized l(m, "auto");
  while (state.KeepRunning()) {
    l.system.schur().assemble(l.u, l.solver->values());
    benchmark::ClobberMemory();
  }
  per_item(state, m.problem().constraints());
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
  per_item(state, m.problem().constraints());
  const auto rate = [](double a) { return Counter(a, Counter::kIsIterationInvariantRate); };
  state.counters["nnz_L"] = l.solver->factor_nonzeros();
  if (solve) {
    const bool single = name == "fixed_pattern_single";
    const double bytes = l.solver->factor_nonzeros() * (single ? sizeof(float) : sizeof(double));
    state.counters["of_bandwidth"] = rate(2 * bytes / harness::read_bandwidth(bytes));
  } else {
    state.counters["flops"] = rate(l.solver->factor_flops());
    state.counters["of_peak"] = rate(l.solver->factor_flops() / harness::peak_flops());
  }
}

// What a projection asks of a linear solver, to the digits that it asks for.
void whole_system(benchmark::State& state, const std::string& name, int n) {
  const Moment& m = moment("drape", n);
  const Linearized l(m, name);
  Eigen::VectorXd x = l.c;
  while (state.KeepRunning()) {
    l.system.schur().assemble(l.u, l.solver->values());
    x = l.c;
    if (!l.solver->factor() || !l.solver->solve_within(1e-2, x.data()))
      return state.SkipWithError("not positive definite");
    benchmark::ClobberMemory();
  }
  per_item(state, m.problem().constraints());
}

// What no pass that corrects every edge can go below: a square root and a division an edge,
// independent of each other, in the first-level cache.
void sqrt_div(std::array<double, 1024>& lengths) {
  for (double& q : lengths) q = 1.5 - 0.5 / std::sqrt(q);
  benchmark::DoNotOptimize(lengths.data());
  benchmark::ClobberMemory();
}

// Seconds for one of each, the best of many: at most what the processor can do undisturbed.
double sqrt_div_seconds() {
  static const double seconds = [] {
    std::array<double, 1024> lengths;
    lengths.fill(1.2);
    double best = 1;
    for (int i = 0; i < 1000; ++i) {
      const double begin = processor_seconds();
      for (int repeat = 0; repeat < 20; ++repeat) sqrt_div(lengths);
      best = std::min(best, processor_seconds() - begin);
    }
    return best / (20 * 1024);
  }();
  return seconds;
}

// One pass over a cloth stretched by a fifth, so that every edge is corrected. A call that
// may not pass at all costs the checks, the refusal and the clock: that is taken off.
template <class Filter>
void strain_pass(benchmark::State& state, int n) {
  const Moment& m = moment("drape", n);
  typename Filter::Settings settings;
  settings.max_iterations = 1;
  Filter one(m.problem(), settings);
  settings.max_iterations = 0;
  Filter none(m.problem(), settings);
  const Positions stretched = 1.2 * m.x0;
  Positions x = stretched;
  WorkCounters work;
  double total = 0;
  while (state.KeepRunning()) {
    x = stretched;
    const double begin = processor_seconds();
    benchmark::DoNotOptimize(none.apply(m.state.x, m.h, x, work));
    const double middle = processor_seconds();
    benchmark::DoNotOptimize(one.apply(m.state.x, m.h, x, work));
    const double seconds = (processor_seconds() - middle) - (middle - begin);
    state.SetIterationTime(seconds);
    total += seconds;
  }
  per_item(state, m.problem().constraints());
  state.counters["floor_ratio"] =
      Counter(total / m.problem().constraints() / sqrt_div_seconds(), Counter::kAvgIterations);
  state.counters["corrected"] =
      Counter(static_cast<double>(work.edge_projections) / m.problem().constraints(),
              Counter::kAvgIterations);
}

// One iteration of a solver as it is in a step: steps from one state, less those of `null`, over
// their iterations. So it holds also what a solver does once a step, a last look at the edges, say.
void iteration(benchmark::State& state, const std::string& name, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  BackendOptions options{.strain_limit = 1e-4};  // so that there is something to do
  for (const SettingInfo& setting : find_backend(name)->settings)
    if (std::string_view(setting.name) == "min_iterations") options.settings[setting.name] = 1.0;
  const auto stepper = make_stepper(name, m.scene.problem, options);
  const auto null = make_stepper("null", m.scene.problem, {});
  const int rounds = std::max(1, 20000 / n);  // so that clock reads do not count
  State s;
  const auto seconds = [&](Stepper& which) {
    const double begin = processor_seconds();
    for (int round = 0; round < rounds; ++round) {
      s = m.state;
      benchmark::DoNotOptimize(which.advance(s, m.h));
    }
    return processor_seconds() - begin;
  };
  s = m.state;
  const StepResult first = stepper->advance(s, m.h);
  if (!first || first.iterations == 0) return state.SkipWithError("refused, or nothing to do");
  while (state.KeepRunning()) {
    const double without = seconds(*null);
    state.SetIterationTime(seconds(*stepper) - without);
  }
  per_item(state, m.problem().constraints() * first.iterations * rounds);
  state.counters["iterations"] = first.iterations;
}

void floor_read(benchmark::State& state, std::size_t bytes) {
  const std::size_t size = bytes / sizeof(double);
  const Eigen::VectorXd data = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(size));
  while (state.KeepRunning()) benchmark::DoNotOptimize(harness::read_all(data.data(), size));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

void floor_multiply_add(benchmark::State& state) {
  constexpr std::size_t times = 1 << 16;
  while (state.KeepRunning()) benchmark::DoNotOptimize(harness::multiply_add(times));
  state.counters["flops"] =
      Counter(harness::flops_of_multiply_add(times), Counter::kIsIterationInvariantRate);
}

// The matrix of ICD's second iteration, about: with fast projection's first multipliers, negative
// ones left out of H, so that there is one factorization. Factoring includes assembling; solving
// includes refinement, or the conjugate gradients to ICD's own tolerance.
void kkt(benchmark::State& state, const std::string& solver, bool solve, int n) {
  const Moment& m = moment("drape", n);
  const Linearized l(m, "fixed_pattern");
  const EdgeConstraints& edges = l.system.edges();
  std::unique_ptr<KktSolver> system;
  if (solver == "projected_cg") {
    system = std::make_unique<ProjectedCg>(m.problem(), edges,
                                           ProjectedCg::Settings{Icd::Settings{}.cg_tolerance});
  } else {
    system = std::make_unique<KktSystem>(m.problem(), edges, solver);
  }
  if (!l.solver->factor()) return state.SkipWithError("not positive definite");
  Eigen::VectorXd mu = l.c, q(edges.count());
  l.solver->solve(mu.data());
  mu /= system->mean_mass();
  const Positions r = Positions::Zero(3, m.x0.cols());
  Positions p = r;
  WorkCounters work;
  if (!system->factor(l.u, mu, true, work)) return state.SkipWithError("singular");
  while (state.KeepRunning()) {
    if (!(solve ? system->solve(r, l.c, p, q, work) : system->factor(l.u, mu, true, work)))
      return state.SkipWithError("singular, or too inaccurate");
  }
  if (work.factorizations != (solve ? 1 : state.iterations() + 1))
    return state.SkipWithError("another solver had to take over");
  per_item(state, edges.count());
  state.counters["nnz_L"] = work.factor_nonzeros;  // umfpack: of L + U
  state.counters["flops"] =
      Counter(solve ? 0 : work.factor_flops, Counter::kIsIterationInvariantRate);
  state.counters["back_solves"] =
      Counter(static_cast<double>(work.back_solves), Counter::kAvgIterations);
}

void vertex_pass(benchmark::State& state, bool collision, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const Problem& problem = m.problem();
  Positions x = m.x0;
  WorkCounters work;
  while (state.KeepRunning()) {
    if (collision) {
      x = m.x0;
      problem.collider()->resolve(m.state.x, problem.inverse_mass(), x, work);
    } else {
      unconstrained_step(problem, m.state, m.h, x, work);
    }
    benchmark::ClobberMemory();
  }
  per_item(state, problem.vertices(), "s_per_vertex");
  if (collision)
    state.counters["contacts"] =
        Counter(static_cast<double>(work.contacts), Counter::kAvgIterations);
}

benchmark::internal::Benchmark* add(const std::string& name,
                                    const std::function<void(benchmark::State&)>& body) {
  return benchmark::RegisterBenchmark(name.c_str(), body)->Unit(benchmark::kMicrosecond);
}

void register_systems(int n, const std::vector<std::string>& solvers) {
  for (const std::string& name : solvers) {
    add("assemble_factor_solve/" + name + "/drape:" + std::to_string(n),
        [=](benchmark::State& s) { whole_system(s, name, n); });
  }
}

void register_scene(const std::string& scene, int n, const std::vector<std::string>& solvers) {
  using State = benchmark::State;
  const std::string at = "/" + scene + ":" + std::to_string(n);
  add("unconstrained_step" + at, [=](State& s) { vertex_pass(s, false, scene, n); });
  add("edge_pass" + at, [=](State& s) { edge_pass(s, true, scene, n); });
  add("strain_check" + at, [=](State& s) { edge_pass(s, false, scene, n); });
  add("assembly" + at, [=](State& s) { assembly(s, scene, n); });
  for (const std::string& name : solvers) {
    add("factor/" + name + at, [=](State& s) { linear_solver(s, name, false, scene, n); });
    add("solve/" + name + at, [=](State& s) { linear_solver(s, name, true, scene, n); });
  }
  if (scene == "chain") {
    for (const std::string name :
         {"fast_projection", "implicit_springs", "shake", "rattle", "icd"}) {
      if (n > 80 && name != "fast_projection" && name != "implicit_springs") continue;
      add("iteration/" + name + at, [=](State& s) {
        iteration(s, name, scene, n);
      })->UseManualTime();
    }
    return;
  }
  add("strain_pass/gauss_seidel" + at, [=](State& s) {
    strain_pass<GaussSeidel>(s, n);
  })->UseManualTime();
  add("strain_pass/gauss_seidel_colored" + at, [=](State& s) {
    strain_pass<GaussSeidelColored>(s, n);
  })->UseManualTime();
  add("strain_pass/jacobi" + at, [=](State& s) { strain_pass<Jacobi>(s, n); })->UseManualTime();
  add("collision_pass" + at, [=](State& s) { vertex_pass(s, true, scene, n); });
  for (const std::string name : {"projected_cg", "quasi_definite", "umfpack"}) {
    add("icd_factor/" + name + at, [=](State& s) { kkt(s, name, false, n); });
    add("icd_solve/" + name + at, [=](State& s) { kkt(s, name, true, n); });
  }
}

}  // namespace

int main(int argc, char** argv) try {
  harness::use_one_thread();
  // Of the other programs that take times; Google Benchmark does not know it.
  char** const end = std::remove_if(
      argv + 1, argv + argc, [](const char* word) { return std::string(word) == "--no-wait"; });
  const bool wait = end == argv + argc;
  argc = static_cast<int>(end - argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  add("floor/sqrt_div", [](benchmark::State& s) {
    std::array<double, 1024> lengths;
    lengths.fill(1.2);
    while (s.KeepRunning()) sqrt_div(lengths);
    per_item(s, 1024, "s_per_edge");
  });
  add("floor/multiply_add", floor_multiply_add);
  for (const std::size_t kib : {16, 512, 8192, 262144})
    add("floor/stream_read/KiB:" + std::to_string(kib),
        [=](benchmark::State& s) { floor_read(s, 1024 * kib); });
  for (const int n : {80, 1000, 100000, 1000000}) register_scene("chain", n, {"tridiagonal"});
  const std::vector<std::string> solvers{"eigen_ldlt",           "cholmod_simplicial",
                                         "cholmod_supernodal",   "fixed_pattern",
                                         "fixed_pattern_single", "line_cg"};
  for (const int n : {15, 31, 71, 101}) register_scene("drape", n, solvers);
  for (const int n : {15, 31, 71, 101, 201, 501})
    register_systems(n, {"eigen_ldlt", "cholmod_simplicial", "cholmod_supernodal", "fixed_pattern",
                         "fixed_pattern_mixed", "line_cg"});
  const harness::TimingLock lock(wait);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
} catch (const harness::UsageError& error) {
  std::fprintf(stderr, "kernels: %s\n", error.what());
  return 2;
}
