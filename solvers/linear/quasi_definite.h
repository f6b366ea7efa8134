// L D L^T of a sparse quasi-definite matrix in its own order, by Eigen's up-looking code. Such a
// matrix has negative pivots, and is factored without pivoting in any order (Vanderbei 1995).
#pragma once

#include <Eigen/SparseCholesky>

#include "solvers/linear/symmetric_pattern.h"

namespace inextensible {

class QuasiDefiniteSolver {
 public:
  explicit QuasiDefiniteSolver(const SymmetricPattern& upper_triangle) {
    const std::vector<double> zeros(upper_triangle.entries(), 0.0);
    matrix_ = Eigen::Map<const Eigen::SparseMatrix<double>>(
        upper_triangle.n, upper_triangle.n, upper_triangle.entries(),
        upper_triangle.column_start.data(), upper_triangle.row_index.data(), zeros.data());
    ldlt_.analyzePattern(matrix_);
  }
  double* values() { return matrix_.valuePtr(); }  // in the pattern's order
  // false: a pivot is zero or not finite.
  bool factor() {
    ldlt_.factorize(matrix_);
    return ldlt_.info() == Eigen::Success && ldlt_.d().allFinite();
  }
  // Overwrites the right-hand side by the solution.
  void solve(double* rhs) const {
    Eigen::Map<Eigen::VectorXd> x(rhs, ldlt_.d().size());
    ldlt_.matrixL().solveInPlace(x);
    x.array() /= ldlt_.d().array();
    ldlt_.matrixU().solveInPlace(x);
  }
  // From the last factorization: the matrix's negative eigenvalues (Sylvester's law of inertia).
  int negative_pivots() const { return static_cast<int>((ldlt_.d().array() < 0).count()); }
  double reciprocal_condition() const {  // smallest over largest pivot
    const auto pivots = ldlt_.d().array().abs();
    return pivots.minCoeff() / pivots.maxCoeff();
  }
  double factor_nonzeros() const { return ldlt_.nonzeros(); }
  double factor_flops() const { return ldlt_.flops(); }

 private:
  struct Ldlt : Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Upper,
                                      Eigen::NaturalOrdering<int>> {
    // vectorD() returns a copy, and so allocates.
    const VectorType& d() const { return m_diag; }
    double nonzeros() const { return (m_nonZerosPerCol.array().cast<double>() + 1).sum(); }
    double flops() const { return (m_nonZerosPerCol.array().cast<double>() + 1).square().sum(); }
  };

  Eigen::SparseMatrix<double> matrix_;
  Ldlt ldlt_;
};

}  // namespace inextensible
