// L D L^T of a sparse quasi-definite matrix in its own order, by Eigen's up-looking code. Such a
// matrix has negative pivots, and is factored without pivoting in any order (Vanderbei 1995).
#pragma once

#include <Eigen/SparseCholesky>

#include "solvers/linear/symmetric_pattern.h"

namespace inextensible {

class QuasiDefiniteSolver {
 public:
  explicit QuasiDefiniteSolver(const SymmetricPattern& upper_triangle);
  double* values() { return matrix_.valuePtr(); }  // in the pattern's order
  bool factor();                                   // false: a pivot is zero or not finite
  void solve(double* rhs) const;                   // overwritten by the solution
  // From the last factorization: the matrix's negative eigenvalues (Sylvester's law of inertia).
  int negative_pivots() const { return negative_pivots_; }
  double reciprocal_condition() const;  // smallest over largest pivot
  double factor_nonzeros() const;
  double factor_flops() const { return flops_; }

 private:
  // Eigen's vectorD() returns a copy, and so allocates.
  struct Ldlt : Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Upper,
                                      Eigen::NaturalOrdering<int>> {
    const VectorType& d() const { return m_diag; }
  };

  Eigen::SparseMatrix<double> matrix_;
  Ldlt ldlt_;
  int negative_pivots_ = 0;
  double flops_ = 0;
};

}  // namespace inextensible
