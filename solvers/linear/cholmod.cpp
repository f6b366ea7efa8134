#include "solvers/linear/cholmod.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>

#include "solvers/linear/cholmod_symbolic.h"

namespace inextensible {
struct CholmodSolver::Library {
  cholmod_common common{};
  cholmod_sparse matrix{};
  cholmod_factor* factor = nullptr;
  cholmod_dense rhs{};
  cholmod_dense *solution = nullptr, *y = nullptr, *e = nullptr;  // reused by cholmod_solve2

  ~Library() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&y, &common);
    cholmod_free_dense(&e, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
};

CholmodSolver::CholmodSolver(SymmetricPattern pattern, bool supernodal)
    : pattern_(std::move(pattern)),
      values_(pattern_.entries()),
      library_(std::make_unique<Library>()) {
  Library& c = *library_;
  cholmod_start_natural(c.common);
  c.common.supernodal = supernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
  c.common.final_ll = supernodal;  // simplicial: L D L^T, without square roots
  c.common.quick_return_if_not_posdef = 1;
  c.matrix = cholmod_view(pattern_, values_.data());
  c.factor = cholmod_analyze(&c.matrix, &c.common);
  if (!c.factor) throw std::bad_alloc();
  c.rhs.nrow = c.rhs.nzmax = c.rhs.d = pattern_.n;
  c.rhs.ncol = 1;
  c.rhs.xtype = CHOLMOD_REAL;
  c.rhs.dtype = CHOLMOD_DOUBLE;
}

CholmodSolver::~CholmodSolver() = default;

bool CholmodSolver::factor() {
  Library& c = *library_;
  // LAPACK's Cholesky, inside the supernodal code, lets NaN pass: no pivot compares as negative.
  if (!std::isfinite(std::accumulate(values_.begin(), values_.end(), 0.0))) return false;
  const bool done = cholmod_factorize(&c.matrix, c.factor, &c.common);
  if (c.common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (!done) return false;
  if (c.common.status != CHOLMOD_OK || c.factor->minor != c.factor->n) return false;
  if (c.factor->is_super || c.factor->is_ll) return true;
  // L D L^T goes on through negative pivots: look at them.
  const auto* start = static_cast<const int*>(c.factor->p);
  const auto* value = static_cast<const double*>(c.factor->x);
  for (int i = 0; i < pattern_.n; ++i) {
    const std::size_t diagonal = pattern_.diagonal(i);
    if (!(value[start[i]] > least_pivot_ * values_[diagonal])) return false;
  }
  return true;
}

void CholmodSolver::solve(double* rhs) {
  Library& c = *library_;
  c.rhs.x = rhs;
  cholmod_solve2(CHOLMOD_A, c.factor, &c.rhs, nullptr, &c.solution, nullptr, &c.y, &c.e, &c.common);
  const auto* x = static_cast<const double*>(c.solution->x);
  std::copy(x, x + pattern_.n, rhs);
}

double CholmodSolver::reciprocal_condition() const {
  return cholmod_rcond(library_->factor, &library_->common);
}

double CholmodSolver::factor_nonzeros() const { return library_->common.lnz; }
double CholmodSolver::factor_flops() const { return library_->common.fl; }

std::vector<int> fill_reducing_order(const SymmetricPattern& pattern) {
  if (pattern.n == 0) return {};
  cholmod_common common{};
  cholmod_start(&common);
  common.print = 0;
  common.nmethods = 2;
  common.method[0].ordering = CHOLMOD_AMD;
  common.method[1].ordering = CHOLMOD_METIS;
  common.postorder = 1;
  cholmod_sparse matrix = cholmod_view(pattern, nullptr);
  cholmod_factor* factor = cholmod_analyze(&matrix, &common);
  if (!factor) {
    cholmod_finish(&common);
    throw std::bad_alloc();
  }
  const auto* permutation = static_cast<const int*>(factor->Perm);
  std::vector<int> order(permutation, permutation + pattern.n);
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
  return order;
}

}  // namespace inextensible
