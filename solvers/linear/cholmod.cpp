// CHOLMOD's supernodal Cholesky (Chen et al. 2008) on a matrix in elimination order.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "solvers/linear/cholmod_symbolic.h"
#include "solvers/linear/spd_solver.h"

namespace inextensible {
namespace {

class CholmodSolver final : public SpdSolver, CholmodAnalysis {
 public:
  explicit CholmodSolver(SymmetricPattern pattern)
      : SpdSolver(pattern.entries()), pattern_(std::move(pattern)) {
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
    common.quick_return_if_not_posdef = 1;
    matrix_ = cholmod_view(pattern_, values_.data());
    analyze(pattern_);
    rhs_.nrow = rhs_.nzmax = rhs_.d = pattern_.n;
    rhs_.ncol = 1;
    rhs_.xtype = CHOLMOD_REAL;
    rhs_.dtype = CHOLMOD_DOUBLE;
  }
  ~CholmodSolver() override {
    for (cholmod_dense** dense : {&solution_, &y_, &e_}) cholmod_free_dense(dense, &common);
  }

  bool factor() override {
    // LAPACK's Cholesky, inside the supernodal code, lets NaN pass: no pivot compares as negative.
    if (!std::isfinite(std::accumulate(values_.begin(), values_.end(), 0.0))) return false;
    const bool done = cholmod_factorize(&matrix_, l, &common);
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    return done && common.status == CHOLMOD_OK && l->minor == l->n;
  }

  void solve(double* rhs) override {
    rhs_.x = rhs;
    cholmod_solve2(CHOLMOD_A, l, &rhs_, nullptr, &solution_, nullptr, &y_, &e_, &common);
    std::copy_n(static_cast<const double*>(solution_->x), pattern_.n, rhs);
  }
  double factor_nonzeros() const override { return common.lnz; }
  double factor_flops() const override { return common.fl; }

 private:
  SymmetricPattern pattern_;
  cholmod_sparse matrix_{};
  cholmod_dense rhs_{};
  cholmod_dense *solution_ = nullptr, *y_ = nullptr, *e_ = nullptr;  // reused by cholmod_solve2
};

}  // namespace

std::unique_ptr<SpdSolver> make_cholmod_supernodal(SymmetricPattern pattern) {
  return std::make_unique<CholmodSolver>(std::move(pattern));
}

std::vector<int> fill_reducing_order(const SymmetricPattern& pattern) {
  if (pattern.n == 0) return {};
  CholmodAnalysis c;
  c.common.nmethods = 2;
  c.common.method[0].ordering = CHOLMOD_AMD;
  c.common.method[1].ordering = CHOLMOD_METIS;
  c.common.postorder = 1;
  c.analyze(pattern);
  const auto* order = static_cast<const int*>(c.l->Perm);
  return {order, order + pattern.n};
}

}  // namespace inextensible
