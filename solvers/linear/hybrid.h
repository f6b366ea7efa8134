// Conjugate gradients while they converge quickly, a factorization where they do not: for matrices
// that begin easy and may become hard.
#pragma once

#include <memory>

#include "solvers/linear/line_cg.h"
#include "solvers/linear/multifrontal_cholesky.h"

namespace inextensible {

class HybridSpdSolver final : public SpdSolver {
 public:
  explicit HybridSpdSolver(SymmetricPattern pattern);  // as LineCgSolver's

  double* values() override { return cg_.values(); }
  bool factor() override;
  void solve(double* rhs) override { solve_within(tightest, rhs); }
  // After a factorization exact to rounding. false also if that found the matrix not positive
  // definite.
  bool solve_within(double tolerance, double* rhs) override;
  std::int64_t iterations() const override { return cg_.iterations(); }
  double reciprocal_condition() const override { return current().reciprocal_condition(); }
  double factor_nonzeros() const override { return current().factor_nonzeros(); }
  double factor_flops() const override { return current().factor_flops(); }

  bool factors() const { return factored_; }  // what the last factor() or solve did

 private:
  void prepare_factorization();
  bool factor_wholly();
  void solve_factored(double* rhs);
  const SpdSolver& current() const {
    return factored_ ? static_cast<const SpdSolver&>(*direct_) : cg_;
  }

  SymmetricPattern pattern_;
  LineCgSolver cg_;
  std::vector<double> rhs_;
  bool factored_ = false;
  int wasted_ = 0;       // CG iterations beyond `quick`, until a factorization is prepared
  int until_retry_ = 0;  // factorizations until CG is tried again
  int retry_interval_;

  // Once prepared: the matrix in elimination order.
  std::vector<int> order_, place_;  // of rows; of entries in direct_->values()
  std::unique_ptr<MultifrontalCholesky<double>> direct_;
};

}  // namespace inextensible
