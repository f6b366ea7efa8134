// kernels: the inner pieces of a step, timed one by one by Google Benchmark, so that the cost of a
// step can be explained from its parts. Names: piece/solver/scene:n. Matrices are those of a cloth
// in mid-drape (above 150 vertices a side soon after its start) and a chain in mid-swing, at the
// positions that a filter gets. collision_pass, strain_pass and solve include a copy of their
// input, a few percent.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/errors.h"
#include "harness/base/timing_lock.h"
#include "harness/points/context.h"
#include "harness/scenes/scene.h"
#include "solvers/linear/spd_solver.h"
#include "solvers/problem/forces.h"
#include "solvers/registry.h"
#include "solvers/systems/constraint_system.h"

namespace harness::kernels {
namespace {

using namespace inextensible;
using benchmark::Counter;

// A scene after some steps of fast projection: deformed, and in contact if there is an obstacle.
// Made once: Google Benchmark calls each benchmark several times.
struct Moment {
  Scene scene;
  double h;  // s
  State state;
  Positions x0;  // after the next unconstrained step
  const Problem& problem() const { return *scene.problem; }
};

const Moment& moment(const std::string& scene, int n) {
  static std::map<std::pair<std::string, int>, Moment> moments;
  const auto [place, is_new] = moments.try_emplace({scene, n});
  Moment& m = place->second;
  if (!is_new) return m;
  m.scene = built_scene(scene, {{"n", n}});
  m.h = scene == "drape" ? 0.005 : std::min(0.001, 1.0 / n);
  m.state = m.scene.start;
  const auto stepper = make_stepper("fast_projection", m.scene.problem, {});
  const int wanted = n > (scene == "drape" ? 150 : 200000) ? 4 : 40;
  int steps = 0;
  while (steps < wanted && stepper->advance(m.state, m.h)) ++steps;
  if (steps < wanted)
    std::fprintf(stderr, "kernels: %s:%d: step %d was refused\n", scene.c_str(), n, steps + 1);
  WorkCounters work;
  unconstrained_step(m.problem(), m.state, m.h, m.x0, work);
  return m;
}

// Times work(), and how long it takes for each of these edges or vertices.
template <class Work>
void time(benchmark::State& state, int items, Work work) {
  for ([[maybe_unused]] const auto iteration : state) {
    work();
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * items);
  state.counters["s_per_item"] =
      Counter(items, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

// ---- Passes over all edges or vertices ----

void edge_pass(benchmark::State& state, bool gradients, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const EdgeConstraints edges(m.problem(), 1);  // nothing violates: the whole pass
  Eigen::Matrix3Xd u(3, edges.count());
  Eigen::VectorXd c(edges.count());
  time(state, edges.count(), [&] {
    benchmark::DoNotOptimize(gradients ? edges.linearize(m.x0, u, c) : edges.permissible(m.x0));
  });
}

void free_step(benchmark::State& state, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  Positions x;
  WorkCounters work;
  time(state, m.problem().vertices(),
       [&] { unconstrained_step(m.problem(), m.state, m.h, x, work); });
}

void collision_pass(benchmark::State& state, const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  Positions x;
  WorkCounters work;
  Contacts contacts(m.problem());
  time(state, m.problem().vertices(), [&] {
    x = m.x0;
    contacts.begin(m.state.x, m.state.time, m.h);
    contacts.push_out(x, work);
  });
}

// Passes over a cloth stretched by a fifth, so that nearly every edge is corrected.
void strain_pass(benchmark::State& state, const std::string& method, int n) {
  constexpr int passes = 10;
  const Moment& m = moment("drape", n);
  const Backend& row = *find_backend(method);
  BackendOptions options{.settings = complete_settings(row, {})};
  options.settings["max_iterations"] = double{passes};
  // A pass over yarns alone.
  if (const auto sweeps = options.settings.find("sweeps"); sweeps != options.settings.end())
    sweeps->second = 0.0;
  const auto filter = row.make_filter(m.problem(), options, Along::edges);
  Positions x;
  WorkCounters work;
  time(state, passes * m.problem().constraints(), [&] {
    x = 1.2 * m.x0;
    benchmark::DoNotOptimize(filter->apply(m.state.x, m.h, x, work));
  });
}

// ---- J W J^T at x0, in the solver's order: assembly, factorization and back-substitution ----

enum class Part { assembly, factor, solve };

void linear_system(benchmark::State& state, const std::string& name, Part part,
                   const std::string& scene, int n) {
  const Moment& m = moment(scene, n);
  const ConstraintSystem system(m.problem(), 0.01, name);
  const int edges = m.problem().constraints();
  Eigen::Matrix3Xd u(3, edges);
  Eigen::VectorXd c(edges);
  system.edges().linearize(m.x0, u, c);
  const auto solver = make_spd_solver(system.solver_name(), system.schur().pattern());
  system.schur().assemble(u, solver->values());
  if (!solver->factor()) return state.SkipWithError("not positive definite");
  Eigen::VectorXd x = c;
  time(state, edges, [&] {
    if (part == Part::assembly) system.schur().assemble(u, solver->values());
    if (part == Part::factor) benchmark::DoNotOptimize(solver->factor());
    if (part != Part::solve) return;
    x = c;
    solver->solve(x.data());
  });
  state.counters["nnz_L"] = solver->factor_nonzeros();
  if (part == Part::factor)
    state.counters["flops"] = Counter(solver->factor_flops(), Counter::kIsIterationInvariantRate);
}

template <class Body, class... Arguments>
void add(const std::string& name, const Body& body, const Arguments&... arguments) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    body(state, arguments...);
  })->Unit(benchmark::kMicrosecond);
}

void register_scene(const std::string& scene, int n, const std::vector<std::string>& solvers) {
  const std::string at = "/" + scene + ":" + std::to_string(n);
  add("unconstrained_step" + at, free_step, scene, n);
  add("edge_pass" + at, edge_pass, true, scene, n);
  add("strain_check" + at, edge_pass, false, scene, n);
  add("assembly" + at, linear_system, solvers.front(), Part::assembly, scene, n);
  for (const std::string& name : solvers) {
    add("factor/" + name + at, linear_system, name, Part::factor, scene, n);
    add("solve/" + name + at, linear_system, name, Part::solve, scene, n);
  }
  if (scene != "drape") return;
  add("collision_pass" + at, collision_pass, scene, n);
  for (const std::string method :
       {"gauss_seidel", "gauss_seidel_colored", "jacobi", "yarn_projection"})
    add("strain_pass/" + method + at, strain_pass, method, n);
}

}  // namespace
}  // namespace harness::kernels

int main(int argc, char** argv) try {
  harness::use_one_thread(argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  for (const int n : {80, 1000, 100000, 1000000})
    harness::kernels::register_scene("chain", n, {"tridiagonal"});
  for (const int n : {15, 31, 71, 101})
    harness::kernels::register_scene("drape", n,
                                     {"multifrontal", "multifrontal_mixed", "cholmod_supernodal"});
  const harness::TimingLock lock;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
} catch (const harness::UsageError& error) {
  std::fprintf(stderr, "kernels: %s\n", error.what());
  return 2;
}
