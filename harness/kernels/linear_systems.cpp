// Assembly, factorization and back-substitution: of J W J^T, and of ICD's saddle point.
#include "harness/kernels/floors.h"
#include "harness/kernels/kernel.h"
#include "solvers/registry.h"
#include "solvers/systems/kkt_system.h"
#include "solvers/systems/projected_cg.h"

namespace harness::kernels {
namespace {

using namespace inextensible;

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
  state.counters["flops"] = rate(solve ? 0 : work.factor_flops);
  state.counters["back_solves"] = average(static_cast<double>(work.back_solves));
}

}  // namespace

void register_linear_systems(const std::string& scene, int n, const std::vector<std::string>& spd,
                             const std::vector<std::string>& saddle_point) {
  const std::string at = "/" + scene + ":" + std::to_string(n);
  add("assembly" + at, assembly, scene, n);
  for (const std::string& name : spd) {
    add("factor/" + name + at, linear_solver, name, false, scene, n);
    add("solve/" + name + at, linear_solver, name, true, scene, n);
  }
  for (const std::string& name : saddle_point) {
    add("icd_factor/" + name + at, kkt, name, false, n);
    add("icd_solve/" + name + at, kkt, name, true, n);
  }
}

void register_whole_systems(int n, const std::vector<std::string>& solvers) {
  for (const std::string& name : solvers)
    add("assemble_factor_solve/" + name + "/drape:" + std::to_string(n), whole_system, name, n);
}

}  // namespace harness::kernels
