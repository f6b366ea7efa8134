#include "constraint_system.h"

#include <cmath>

namespace inextensible {
namespace {

std::string choose(std::string_view wanted, const SymmetricPattern& pattern) {
  if (wanted != "auto") return std::string(wanted);
  if (pattern.entries() == 2 * pattern.n - 1 && pattern.tridiagonal()) return "tridiagonal";
  return "fixed_pattern";
}

}  // namespace

ConstraintSystem::ConstraintSystem(const Problem& problem, double strain_limit,
                                   std::string_view linear_solver) {
  const EdgeConstraints natural(problem, strain_limit);
  const SchurComplement unordered(natural, problem.vertices(), SymmetricPattern::Triangle::upper);
  solver_name_ = choose(linear_solver, unordered.pattern());
  std::vector<int> order;
  if (solver_name_ != "tridiagonal") order = fill_reducing_order(unordered.pattern());
  edges_ = std::make_unique<EdgeConstraints>(problem, strain_limit, std::move(order));
  schur_ =
      std::make_unique<SchurComplement>(*edges_, problem.vertices(), triangle_of(solver_name_));
  solver_ = make_spd_solver(solver_name_, schur_->pattern());
  solver_->set_least_pivot(least_pivot);
}

bool ConstraintSystem::factor(const Eigen::Matrix3Xd& u, WorkCounters& work, double damping) {
  schur_->assemble(u, solver_->values());
  if (damping > 0) schur_->scale_diagonal(1 + damping, solver_->values());
  ++work.assemblies;
  ++work.factorizations;
  const bool factored = solver_->factor();
  work.factor_nonzeros = solver_->factor_nonzeros();
  work.factor_flops = solver_->factor_flops();
  return factored;
}

void ConstraintSystem::solve(Eigen::VectorXd& mu, WorkCounters& work) {
  solver_->solve(mu.data());
  ++work.back_solves;
}

StepResult refuse(Status status, int iterations, const EdgeConstraints& edges, const Positions& x,
                  const char* detail) {
  const auto worst = edges.worst(x);
  if (!std::isfinite(worst.strain))
    return {Status::not_finite, iterations, worst.edge, worst.strain, "overflow"};
  return {status, iterations, worst.edge, worst.strain, detail};
}

}  // namespace inextensible
