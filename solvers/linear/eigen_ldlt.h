// Eigen's up-looking sparse L D L^T on a matrix in elimination order.
#pragma once

#include <Eigen/SparseCholesky>

#include "solvers/linear/spd_solver.h"

namespace inextensible {

class EigenLdltSolver final : public SpdSolver {
 public:
  // Reads the upper triangle. indefinite: negative pivots are taken as they come (quasi-definite
  // matrices, which have an L D L^T in any order: Vanderbei 1995), only zero or non-finite ones are
  // refused.
  explicit EigenLdltSolver(const SymmetricPattern& pattern, bool indefinite = false);
  double* values() override { return matrix_.valuePtr(); }
  bool factor() override;
  void solve(double* rhs) override;
  // Of the last factorization: the matrix's negative eigenvalues (Sylvester's law of inertia).
  int negative_pivots() const { return negative_pivots_; }
  double reciprocal_condition() const override;
  double factor_nonzeros() const override;
  double factor_flops() const override { return flops_; }

 private:
  // Eigen's vectorD() returns a copy, and so allocates.
  struct Ldlt : Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Upper,
                                      Eigen::NaturalOrdering<int>> {
    const VectorType& d() const { return m_diag; }
  };

  Eigen::SparseMatrix<double> matrix_;
  Ldlt ldlt_;
  bool indefinite_;
  int negative_pivots_ = 0;
  double flops_ = 0;
};

}  // namespace inextensible
