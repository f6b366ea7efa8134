// CHOLMOD's simplicial and supernodal Cholesky (Chen et al. 2008) on a matrix in elimination order.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "solvers/linear/cholmod_symbolic.h"
#include "solvers/linear/spd_solver.h"

namespace inextensible {
namespace {

class CholmodSolver final : public SpdSolver, CholmodAnalysis {
 public:
  CholmodSolver(SymmetricPattern pattern, int supernodal)
      : SpdSolver(pattern.entries()), pattern_(std::move(pattern)) {
    common.supernodal = supernodal;
    common.final_ll = supernodal == CHOLMOD_SUPERNODAL;  // simplicial: L D L^T
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
    if (!done || common.status != CHOLMOD_OK || l->minor != l->n) return false;
    if (l->is_super || l->is_ll) return true;
    // L D L^T goes on through negative pivots: look at them.
    const auto* start = static_cast<const int*>(l->p);
    const auto* value = static_cast<const double*>(l->x);
    for (int i = 0; i < pattern_.n; ++i) {
      const std::size_t diagonal = pattern_.diagonal(i);
      if (!(value[start[i]] > least_pivot_ * values_[diagonal])) return false;
    }
    return true;
  }

  void solve(double* rhs) override {
    rhs_.x = rhs;
    cholmod_solve2(CHOLMOD_A, l, &rhs_, nullptr, &solution_, nullptr, &y_, &e_, &common);
    std::copy_n(static_cast<const double*>(solution_->x), pattern_.n, rhs);
  }
  double reciprocal_condition() const override { return cholmod_rcond(l, &common); }
  double factor_nonzeros() const override { return common.lnz; }
  double factor_flops() const override { return common.fl; }

 private:
  SymmetricPattern pattern_;
  cholmod_sparse matrix_{};
  cholmod_dense rhs_{};
  cholmod_dense *solution_ = nullptr, *y_ = nullptr, *e_ = nullptr;  // reused by cholmod_solve2
};

}  // namespace

std::unique_ptr<SpdSolver> make_cholmod_simplicial(SymmetricPattern pattern) {
  return std::make_unique<CholmodSolver>(std::move(pattern), CHOLMOD_SIMPLICIAL);
}
std::unique_ptr<SpdSolver> make_cholmod_supernodal(SymmetricPattern pattern) {
  return std::make_unique<CholmodSolver>(std::move(pattern), CHOLMOD_SUPERNODAL);
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
