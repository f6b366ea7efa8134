#include "tridiagonal_solver.h"

#include <algorithm>
#include <stdexcept>

namespace inextensible {

TridiagonalSolver::TridiagonalSolver(const SymmetricPattern& pattern) : n_(pattern.n) {
  if (!pattern.tridiagonal() || pattern.triangle != SymmetricPattern::Triangle::upper ||
      pattern.entries() != 2 * pattern.n - 1) {
    throw std::invalid_argument(
        "the linear solver 'tridiagonal' needs constraints that form one chain in order");
  }
  values_.resize(static_cast<std::size_t>(pattern.entries()));
  l_.resize(static_cast<std::size_t>(n_));
  inverse_d_.resize(static_cast<std::size_t>(n_));
}

bool TridiagonalSolver::factor() {
  const double* entry = values_.data();
  double d = *entry++;
  if (!(d > 0)) return false;
  inverse_d_[0] = 1 / d;
  const auto n = static_cast<std::size_t>(n_);
  for (std::size_t i = 1; i < n; ++i) {
    const double e = *entry++;
    const double a = *entry++;
    l_[i] = e * inverse_d_[i - 1];
    d = a - l_[i] * e;
    if (!(d > least_pivot_ * a)) return false;  // the negation catches NaN
    inverse_d_[i] = 1 / d;
  }
  return true;
}

double TridiagonalSolver::reciprocal_condition() const {
  const auto [low, high] = std::minmax_element(inverse_d_.begin(), inverse_d_.end());
  return *low / *high;
}

void TridiagonalSolver::solve(double* rhs) {
  const auto n = static_cast<std::size_t>(n_);
  for (std::size_t i = 1; i < n; ++i) rhs[i] -= l_[i] * rhs[i - 1];
  rhs[n - 1] *= inverse_d_[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) rhs[i] = rhs[i] * inverse_d_[i] - l_[i + 1] * rhs[i + 1];
}

}  // namespace inextensible
