// A factorization in single precision where that is enough, in double precision where it is not:
// for solves that are asked for few digits (SpdSolver::solve_within). Right-hand sides and
// solutions are in double precision; more digits than the factorization has come by iterative
// refinement (Wilkinson 1963), whose residuals are computed in double precision.
#pragma once

#include "solvers/linear/multifrontal_cholesky.h"

namespace inextensible {

class MixedCholesky final : public SpdSolver {
 public:
  explicit MixedCholesky(SymmetricPattern pattern);  // as MultifrontalCholesky's

  double* values() override { return single_.values(); }
  // In double precision if a pivot has too few digits in single precision.
  bool factor() override;
  void solve(double* rhs) override { solve_within(tightest, rhs); }
  // Without a look at the residual where the pivots promise more than `tolerance`. In double
  // precision if refinement does not get there; false if the matrix is not positive definite then.
  bool solve_within(double tolerance, double* rhs) override;
  double reciprocal_condition() const override { return current().reciprocal_condition(); }
  double factor_nonzeros() const override { return single_.factor_nonzeros(); }
  double factor_flops() const override { return single_.factor_flops(); }

  bool in_double_precision() const { return in_double_; }  // the last factor() or solve

 private:
  bool factor_in_double();
  bool refine(double tolerance, double* x);
  void subtract_product(const double* x);
  const SpdSolver& current() const {
    return in_double_ ? static_cast<const SpdSolver&>(double_) : single_;
  }

  SymmetricPattern pattern_;
  MultifrontalCholesky<float> single_;
  MultifrontalCholesky<double> double_;
  std::vector<double> rhs_, residual_;
  bool in_double_ = false;
  double accuracy_ = 0;  // of a solve in single precision, as the pivots promise it
};

}  // namespace inextensible
