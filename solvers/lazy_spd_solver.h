// A factor that is kept while the matrix changes (lazy refactorization): conjugate gradients with
// the factor of an earlier matrix of the same pattern as the preconditioner.
#pragma once

#include "fixed_pattern_cholesky.h"

namespace inextensible {

class LazySpdSolver final : public SpdSolver {
 public:
  explicit LazySpdSolver(SymmetricPattern pattern);  // as FixedPatternCholesky's

  double* values() override { return values_.data(); }
  // Factors only if the kept factor has become too poor; false: not positive definite, as far as
  // single precision can tell.
  bool factor() override;
  void solve(double* rhs) override { solve_within(tightest, rhs); }
  bool solve_within(double tolerance, double* rhs) override;
  std::int64_t iterations() const override { return iterations_; }
  std::int64_t skipped_factorizations() const override { return skipped_; }
  // Of the kept factor.
  double reciprocal_condition() const override { return kept_.reciprocal_condition(); }
  double factor_nonzeros() const override { return kept_.factor_nonzeros(); }
  double factor_flops() const override { return kept_.factor_flops(); }

 private:
  enum class Outcome { solved, slow, indefinite };
  bool factor_anew();
  Outcome iterate(double goal, int most);
  void multiply(const std::vector<double>& x, std::vector<double>& y) const;

  SymmetricPattern pattern_;
  std::vector<double> values_;
  MultifrontalCholesky<float> kept_;
  bool has_factor_ = false, fresh_ = false;  // fresh: of these values
  int rent_ = 0;  // iterations beyond the first of each solve, since the last factorization
  std::int64_t iterations_ = 0, skipped_ = 0;
  std::vector<double> x_, residual_, preconditioned_, direction_, image_;
};

}  // namespace inextensible
