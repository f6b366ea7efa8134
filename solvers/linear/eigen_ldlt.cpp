#include "solvers/linear/eigen_ldlt.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace inextensible {

EigenLdltSolver::EigenLdltSolver(const SymmetricPattern& pattern, bool indefinite)
    : indefinite_(indefinite) {
  if (pattern.triangle != SymmetricPattern::Triangle::upper) {
    throw std::invalid_argument("eigen_ldlt reads the upper triangle");
  }
  const std::vector<double> zeros(pattern.entries(), 0.0);
  matrix_ = Eigen::Map<const Eigen::SparseMatrix<double>>(pattern.n, pattern.n, pattern.entries(),
                                                          pattern.column_start.data(),
                                                          pattern.row_index.data(), zeros.data());
  ldlt_.analyzePattern(matrix_);
}

bool EigenLdltSolver::factor() {
  ldlt_.factorize(matrix_);
  if (ldlt_.info() != Eigen::Success) return false;
  const auto& d = ldlt_.d();
  const double* value = matrix_.valuePtr();
  const int* column_end = matrix_.outerIndexPtr() + 1;  // the diagonal is a column's last entry
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    if (indefinite_ ? !std::isfinite(d[i]) : !(d[i] > least_pivot_ * value[column_end[i] - 1]))
      return false;
  }
  negative_pivots_ = static_cast<int>((d.array() < 0).count());
  if (flops_ == 0) {  // sum of squared column counts: the pattern of L is known after the first
                      // factorization only
    const auto& l = ldlt_.matrixL().nestedExpression();
    for (Eigen::Index j = 0; j < l.outerSize(); ++j) {
      const double count = 1 + l.outerIndexPtr()[j + 1] - l.outerIndexPtr()[j];
      flops_ += count * count;
    }
  }
  return true;
}

void EigenLdltSolver::solve(double* rhs) {
  const auto& l = ldlt_.matrixL().nestedExpression();
  const int* start = l.outerIndexPtr();
  const int* row = l.innerIndexPtr();
  const double* value = l.valuePtr();
  const auto& d = ldlt_.d();
  const auto n = static_cast<int>(l.outerSize());
  for (int j = 0; j < n; ++j) {  // L y = b
    const double y = rhs[j];
    for (int i = start[j]; i < start[j + 1]; ++i) rhs[row[i]] -= value[i] * y;
  }
  for (int j = n - 1; j >= 0; --j) {  // L^T x = D^-1 y
    double x = rhs[j] / d[j];
    for (int i = start[j]; i < start[j + 1]; ++i) x -= value[i] * rhs[row[i]];
    rhs[j] = x;
  }
}

double EigenLdltSolver::reciprocal_condition() const {
  const auto pivots = ldlt_.d().array().abs();
  return pivots.minCoeff() / pivots.maxCoeff();
}

double EigenLdltSolver::factor_nonzeros() const {
  const auto& l = ldlt_.matrixL().nestedExpression();
  return static_cast<double>(l.nonZeros() + l.outerSize());
}

}  // namespace inextensible
