#include "solvers/linear/quasi_definite.h"

namespace inextensible {

QuasiDefiniteSolver::QuasiDefiniteSolver(const SymmetricPattern& upper_triangle) {
  const std::vector<double> zeros(upper_triangle.entries(), 0.0);
  matrix_ = Eigen::Map<const Eigen::SparseMatrix<double>>(
      upper_triangle.n, upper_triangle.n, upper_triangle.entries(),
      upper_triangle.column_start.data(), upper_triangle.row_index.data(), zeros.data());
  ldlt_.analyzePattern(matrix_);
}

bool QuasiDefiniteSolver::factor() {
  ldlt_.factorize(matrix_);  // which refuses a pivot of zero
  if (ldlt_.info() != Eigen::Success || !ldlt_.d().allFinite()) return false;
  negative_pivots_ = static_cast<int>((ldlt_.d().array() < 0).count());
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

void QuasiDefiniteSolver::solve(double* rhs) const {
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

double QuasiDefiniteSolver::reciprocal_condition() const {
  const auto pivots = ldlt_.d().array().abs();
  return pivots.minCoeff() / pivots.maxCoeff();
}

double QuasiDefiniteSolver::factor_nonzeros() const {
  const auto& l = ldlt_.matrixL().nestedExpression();
  return static_cast<double>(l.nonZeros() + l.outerSize());
}

}  // namespace inextensible
