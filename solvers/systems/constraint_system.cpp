#include "solvers/systems/constraint_system.h"

namespace inextensible {
namespace {

std::string choose(std::string_view wanted, const SymmetricPattern& pattern,
                   ConstraintSystem::Digits digits) {
  if (wanted != "auto") return std::string(wanted);
  if (pattern.chain(1)) return "tridiagonal";
  return digits == ConstraintSystem::Digits::few ? "multifrontal_mixed" : "multifrontal";
}

}  // namespace

ConstraintSystem::ConstraintSystem(const Problem& problem, double strain_limit,
                                   std::string_view linear_solver, Digits digits) {
  const auto natural = SymmetricPattern::Triangle::upper;
  edges_ = std::make_unique<EdgeConstraints>(problem, strain_limit);
  schur_ = std::make_unique<SchurComplement>(*edges_, problem.vertices(), natural);
  solver_name_ = choose(linear_solver, schur_->pattern(), digits);
  const SpdSolverRow& row = spd_solver(solver_name_);
  if (row.takes == Takes::any) {
    edges_ = std::make_unique<EdgeConstraints>(problem, strain_limit,
                                               fill_reducing_order(schur_->pattern()));
    schur_ = std::make_unique<SchurComplement>(*edges_, problem.vertices(), row.triangle);
  }
  solver_ = make_spd_solver(solver_name_, schur_->pattern());
  solver_->set_least_pivot(least_pivot);
  chain_ = row.takes == Takes::tridiagonal;
}

bool ConstraintSystem::factor(const Eigen::Matrix3Xd& u, const Contacts* contacts,
                              WorkCounters& work, double damping) {
  double* values = solver_->values();
  const SymmetricPattern& pattern = schur_->pattern();
  schur_->assemble(u, values);
  for (int k = 0; damping > 0 && k < pattern.n; ++k) values[pattern.diagonal(k)] *= 1 + damping;
  if (contacts) schur_->subtract_contacts(*contacts, u, u, values);
  ++work.assemblies;
  return factor_counted(*solver_, work);
}

bool ConstraintSystem::solve(Eigen::VectorXd& mu, WorkCounters& work, double tolerance) {
  double largest = 0;
  for (const double c : mu) largest = std::max(largest, std::abs(c));
  const bool solved = solver_->solve_within(tolerance, mu.data());
  ++work.back_solves;
  if (!solved || chain_) return solved;
  const double* values = solver_->values();
  const SymmetricPattern& pattern = schur_->pattern();
  bool moderate = true;
  for (int k = 0; k < pattern.n; ++k)
    moderate &= std::abs(mu[k]) * values[pattern.diagonal(k)] <= largest_growth * largest;
  return moderate;
}

StepResult refuse(Status status, int iterations, const EdgeConstraints& edges, const Positions& x,
                  const char* detail) {
  const auto worst = edges.worst(x);
  if (!std::isfinite(worst.strain))
    return {Status::not_finite, iterations, worst.edge, worst.strain, "overflow"};
  return {status, iterations, worst.edge, worst.strain, detail};
}

}  // namespace inextensible
