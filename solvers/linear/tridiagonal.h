// L D L^T of a symmetric tridiagonal matrix (Golub and Van Loan, Matrix Computations,
// section 4.3.6), from both ends at once (twisted: van der Vorst 1987): O(n), no pivoting.
#pragma once

#include "solvers/linear/spd_solver.h"

namespace inextensible {

class TridiagonalSolver final : public SpdSolver {
 public:
  // The pattern must hold every diagonal entry and every one beside it (zeros are stored).
  explicit TridiagonalSolver(const SymmetricPattern& pattern);
  double* values() override { return values_.data(); }
  bool factor() override;
  void solve(double* rhs) override;
  double reciprocal_condition() const override;
  double factor_nonzeros() const override { return 2.0 * static_cast<double>(n_) - 1; }
  double factor_flops() const override { return 3.0 * static_cast<double>(n_); }

 private:
  std::size_t n_;
  std::vector<double> values_;  // upper triangle: d_0, (e_1, d_1), (e_2, d_2), ...
  std::vector<double> l_;       // the factor's entry between rows i - 1 and i, i from 1 on
  std::vector<double> inverse_d_;
};

}  // namespace inextensible
