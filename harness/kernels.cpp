// kernels: the inner pieces of a step, timed one by one by Google Benchmark, so that the cost of a
// step can be explained from its parts. Names: piece/solver/scene:size. Matrices are those of a
// cloth in mid-drape and a chain in mid-swing.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <string>

#include "constraint_system.h"
#include "context.h"
#include "forces.h"
#include "gauss_seidel.h"
#include "jacobi.h"
#include "kkt_system.h"
#include "registry.h"
#include "scene.h"

namespace {

using namespace inextensible;
using benchmark::Counter;

// A scene after a fifth of a second of fast projection: deformed, in contact where there is
// something to touch.
struct Moment {
  harness::Scene scene;
  State state;
};

Moment moment(const std::string& scene_name, int n) {
  const harness::SceneType& type = *harness::find_scene(scene_name);
  Moment result{type.build(complete_parameters(type, {{"n", n}})), {}};
  result.state = result.scene.start;
  const auto stepper = make_stepper("fast_projection", result.scene.problem, {});
  // Small steps for long chains; a refused step leaves the last good state, which serves as well.
  for (int i = 0; i < 40 && stepper->advance(result.state, scene_name == "drape" ? 0.005 : 0.001);
       ++i) {
  }
  return result;
}

struct Linearized {
  explicit Linearized(const Moment& m, std::string_view solver)
      : system(*m.scene.problem, 0.01, solver),
        u(3, m.scene.problem->constraints()),
        c(m.scene.problem->constraints()) {
    system.edges().linearize(m.state.x, u, c);
  }
  ConstraintSystem system;
  Eigen::Matrix3Xd u;
  Eigen::VectorXd c;
};

void per_item(benchmark::State& state, double items, const char* what) {
  state.counters[what] = Counter(items, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void edge_pass(benchmark::State& state, const std::string& scene, int n) {
  const Moment m = moment(scene, n);
  const EdgeConstraints edges(*m.scene.problem, 0.01);
  Eigen::Matrix3Xd u(3, edges.count());
  Eigen::VectorXd c(edges.count());
  while (state.KeepRunning()) benchmark::DoNotOptimize(edges.linearize(m.state.x, u, c));
  per_item(state, edges.count(), "s_per_edge");
}

void strain_check(benchmark::State& state, const std::string& scene, int n) {
  const Moment m = moment(scene, n);
  const EdgeConstraints edges(*m.scene.problem, 1);  // nothing violates: the whole pass
  while (state.KeepRunning()) benchmark::DoNotOptimize(edges.permissible(m.state.x));
  per_item(state, edges.count(), "s_per_edge");
}

void assembly(benchmark::State& state, const std::string& scene, int n) {
  const Moment m = moment(scene, n);
  const Linearized linearized(m, "auto");
  std::vector<double> values(
      static_cast<std::size_t>(linearized.system.schur().pattern().entries()));
  while (state.KeepRunning()) {
    linearized.system.schur().assemble(linearized.u, values.data());
    benchmark::ClobberMemory();
  }
  per_item(state, static_cast<double>(values.size()), "s_per_entry");
}

void factor(benchmark::State& state, const std::string& solver, const std::string& scene, int n) {
  const Moment m = moment(scene, n);
  Linearized linearized(m, solver);
  WorkCounters work;
  while (state.KeepRunning()) {
    if (!linearized.system.factor(linearized.u, work))
      return state.SkipWithError("not positive definite");
  }
  state.counters["nnz_L"] = work.factor_nonzeros;
  state.counters["flops"] = Counter(work.factor_flops, Counter::kIsIterationInvariantRate);
}

void back_solve(benchmark::State& state, const std::string& solver, const std::string& scene,
                int n) {
  const Moment m = moment(scene, n);
  Linearized linearized(m, solver);
  WorkCounters work;
  if (!linearized.system.factor(linearized.u, work))
    return state.SkipWithError("not positive definite");
  Eigen::VectorXd x = linearized.c;
  while (state.KeepRunning()) {
    x = linearized.c;
    linearized.system.solve(x, work);
  }
  // L is read twice, values and row indices.
  state.counters["bytes"] = Counter(2 * work.factor_nonzeros * (sizeof(double) + sizeof(int)),
                                    Counter::kIsIterationInvariantRate);
}

// One sweep from a cloth stretched by 5 %, so that every edge is corrected.
template <class Filter>
void sweep(benchmark::State& state, const std::string& scene, int n) {
  const Moment m = moment(scene, n);
  typename Filter::Settings settings;
  settings.max_iterations = 1;
  Filter filter(*m.scene.problem, settings);
  const Positions stretched = 1.05 * m.state.x;
  Positions x = stretched;
  WorkCounters work;
  while (state.KeepRunning()) {
    x = stretched;
    benchmark::DoNotOptimize(filter.apply(m.state.x, 0.01, x, work));
  }
  per_item(state, m.scene.problem->constraints(), "s_per_edge");
}

void kkt(benchmark::State& state, const std::string& solver, bool solve, int n) {
  const Moment m = moment("drape", n);
  const EdgeConstraints edges(*m.scene.problem, 0.01);
  KktSystem system(*m.scene.problem, edges, solver);
  Eigen::Matrix3Xd u(3, edges.count());
  Eigen::VectorXd c(edges.count()), q(edges.count());
  edges.linearize(m.state.x, u, c);
  const Eigen::VectorXd mu = Eigen::VectorXd::Constant(edges.count(), 1e-3);
  const Positions r = Positions::Zero(3, m.state.x.cols());
  Positions p = r;
  WorkCounters work;
  if (!system.factor(u, mu, false, work)) return state.SkipWithError("singular");
  while (state.KeepRunning()) {
    if (solve) {
      benchmark::DoNotOptimize(system.solve(r, c, p, q, work));
    } else {
      benchmark::DoNotOptimize(system.factor(u, mu, false, work));
    }
  }
  state.counters["nnz_L"] = work.factor_nonzeros;
  state.counters["flops"] =
      Counter(solve ? 0 : work.factor_flops, Counter::kIsIterationInvariantRate);
}

void collision_pass(benchmark::State& state, int n) {
  const Moment m = moment("drape", n);
  const Problem& problem = *m.scene.problem;
  Positions candidate(3, problem.vertices()), x = candidate;
  WorkCounters work;
  unconstrained_step(problem, m.state, 0.005, candidate, work);
  while (state.KeepRunning()) {
    x = candidate;
    problem.collider()->resolve(m.state.x, problem.inverse_mass(), x, work);
  }
  per_item(state, problem.vertices(), "s_per_vertex");
  state.counters["contacts"] =
      static_cast<double>(work.contacts) / static_cast<double>(state.iterations());
}

void free_step(benchmark::State& state, const std::string& scene, int n) {
  const Moment m = moment(scene, n);
  Positions x(3, m.scene.problem->vertices());
  WorkCounters work;
  while (state.KeepRunning()) {
    unconstrained_step(*m.scene.problem, m.state, 0.005, x, work);
    benchmark::ClobberMemory();
  }
  per_item(state, m.scene.problem->vertices(), "s_per_vertex");
}

void add(const std::string& name, const std::function<void(benchmark::State&)>& body) {
  benchmark::RegisterBenchmark(name.c_str(), body)->Unit(benchmark::kMicrosecond);
}

void register_all() {
  using State = benchmark::State;
  const std::string chain = "chain", drape = "drape";
  for (const int n : {80, 1000, 100000}) {
    const std::string at = "/chain:" + std::to_string(n);
    add("edge_pass" + at, [=](State& s) { edge_pass(s, chain, n); });
    add("assembly" + at, [=](State& s) { assembly(s, chain, n); });
    add("assembly+factor/tridiagonal" + at, [=](State& s) { factor(s, "tridiagonal", chain, n); });
    add("solve/tridiagonal" + at, [=](State& s) { back_solve(s, "tridiagonal", chain, n); });
  }
  for (const int n : {15, 31, 71, 101}) {
    const std::string at = "/drape:" + std::to_string(n);
    add("unconstrained_step" + at, [=](State& s) { free_step(s, drape, n); });
    add("edge_pass" + at, [=](State& s) { edge_pass(s, drape, n); });
    add("strain_check" + at, [=](State& s) { strain_check(s, drape, n); });
    add("assembly" + at, [=](State& s) { assembly(s, drape, n); });
    for (const std::string solver : {"eigen_ldlt", "cholmod_simplicial", "cholmod_supernodal"}) {
      add("assembly+factor/" + solver + at, [=](State& s) { factor(s, solver, drape, n); });
      add("solve/" + solver + at, [=](State& s) { back_solve(s, solver, drape, n); });
    }
    add("sweep/gauss_seidel" + at, [=](State& s) { sweep<GaussSeidel>(s, drape, n); });
    add("sweep/jacobi" + at, [=](State& s) { sweep<Jacobi>(s, drape, n); });
    add("collision_pass" + at, [=](State& s) { collision_pass(s, n); });
    for (const std::string solver : {"quasi_definite", "umfpack"}) {
      add("icd_assembly+factor/" + solver + at, [=](State& s) { kkt(s, solver, false, n); });
      add("icd_solve/" + solver + at, [=](State& s) { kkt(s, solver, true, n); });
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  harness::use_one_blas_thread();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  register_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
