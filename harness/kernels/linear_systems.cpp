// Assembly, factorization and back-substitution: of J W J^T, and of ICD's saddle point.
#include <string_view>

#include "harness/kernels/hardware_peak.h"
#include "harness/kernels/kernel.h"
#include "solvers/linear/spd_solvers.h"
#include "solvers/registry.h"
#include "solvers/systems/kkt_system.h"
#include "solvers/systems/projected_cg.h"

namespace harness::kernels {
namespace {

using namespace inextensible;
using benchmark::Counter;

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
    const double bytes = l.solver->factor_nonzeros() * sizeof(double);
    state.counters["of_bandwidth"] = rate(2 * bytes / read_bandwidth(bytes));
  } else {
    state.counters["flops"] = rate(l.solver->factor_flops());
    state.counters["of_peak"] = rate(l.solver->factor_flops() / peak_flops());
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

// The matrix of ICD's second iteration, about: with fast projection's first multipliers, negative
// ones left out of H, so that there is one factorization. Factoring includes assembling; solving
// includes refinement, or the conjugate gradients to ICD's own tolerance.
void kkt(benchmark::State& state, const std::string& solver, bool solve, int n) {
  const Moment& m = moment("drape", n);
  const Linearized l(m, "multifrontal");
  const EdgeConstraints& edges = l.system.edges();
  std::unique_ptr<KktSolver> system;
  if (solver == "projected_cg") {
    const Settings settings = complete_settings(*find_backend("icd"), {});
    const double tolerance = std::get<double>(settings.at("cg_tolerance"));
    system = std::make_unique<ProjectedCg>(m.problem(), edges, ProjectedCg::Settings{tolerance});
  } else {
    system = std::make_unique<KktSystem>(m.problem(), edges);
  }
  if (!l.solver->factor()) return state.SkipWithError("not positive definite");
  Eigen::VectorXd mu = l.c, q(edges.count());
  l.solver->solve(mu.data());
  mu /= system->mean_mass();
  const Positions r = Positions::Zero(3, m.x0.cols());
  Positions p = r;
  WorkCounters work;
  if (!system->factor(l.u, mu, nullptr, true, work)) return state.SkipWithError("singular");
  while (state.KeepRunning()) {
    if (!(solve ? system->solve(r, l.c, p, q, work) : system->factor(l.u, mu, nullptr, true, work)))
      return state.SkipWithError("singular, or too inaccurate");
  }
  if (work.factorizations != (solve ? 1 : state.iterations() + 1))
    return state.SkipWithError("another solver had to take over");
  per_item(state, edges.count());
  state.counters["nnz_L"] = work.factor_nonzeros;
  state.counters["flops"] =
      Counter(solve ? 0 : work.factor_flops, Counter::kIsIterationInvariantRate);
  state.counters["back_solves"] =
      Counter(static_cast<double>(work.back_solves), Counter::kAvgIterations);
}

}  // namespace

void register_schur_complement(const std::string& scene, int n, const std::string& at,
                               const std::vector<std::string>& solvers) {
  using State = benchmark::State;
  add("assembly" + at, [=](State& s) { assembly(s, scene, n); });
  for (const std::string& name : solvers) {
    add("factor/" + name + at, [=](State& s) { linear_solver(s, name, false, scene, n); });
    add("solve/" + name + at, [=](State& s) { linear_solver(s, name, true, scene, n); });
  }
}

void register_whole_systems(int n, const std::vector<std::string>& solvers) {
  for (const std::string& name : solvers) {
    add("assemble_factor_solve/" + name + "/drape:" + std::to_string(n),
        [=](benchmark::State& s) { whole_system(s, name, n); });
  }
}

void register_saddle_point(int n, const std::string& at, const std::vector<std::string>& solvers) {
  for (const std::string& name : solvers) {
    add("icd_factor/" + name + at, [=](benchmark::State& s) { kkt(s, name, false, n); });
    add("icd_solve/" + name + at, [=](benchmark::State& s) { kkt(s, name, true, n); });
  }
}

}  // namespace harness::kernels
