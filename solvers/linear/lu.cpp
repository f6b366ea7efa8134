#include <umfpack.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>

#include "solvers/linear/spd_solver.h"

extern "C" {  // LAPACK
void dgttrf_(const int* n, double* dl, double* d, double* du, double* du2, int* ipiv, int* info);
void dgttrs_(const char* trans, const int* n, const int* nrhs, const double* dl, const double* d,
             const double* du, const double* du2, const int* ipiv, double* b, const int* ldb,
             int* info);
}

namespace inextensible {
namespace {

constexpr double singular_rcond = 1e-15;

class UmfpackSolver final : public DirectSolver {
 public:
  explicit UmfpackSolver(SymmetricPattern pattern)
      : DirectSolver(pattern.entries()),
        pattern_(std::move(pattern)),
        solution_(pattern_.n),
        int_work_(pattern_.n),
        work_(5 * solution_.size()) {
    umfpack_di_defaults(control_.data());
    control_[UMFPACK_IRSTEP] = 0;  // callers refine where they need it
  }

  ~UmfpackSolver() override {
    umfpack_di_free_numeric(&numeric_);
    umfpack_di_free_symbolic(&symbolic_);
  }

  bool factor() override {
    if (!std::all_of(values_.begin(), values_.end(), [](double v) { return std::isfinite(v); }))
      return false;
    const int *start = pattern_.column_start.data(), *row = pattern_.row_index.data();
    if (!symbolic_) {  // with values, so that the strategy suits the matrix; then reused
      const int status = umfpack_di_symbolic(pattern_.n, pattern_.n, start, row, values_.data(),
                                             &symbolic_, control_.data(), info_.data());
      if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
      if (status != UMFPACK_OK) return false;
    }
    umfpack_di_free_numeric(&numeric_);
    const int status = umfpack_di_numeric(start, row, values_.data(), symbolic_, &numeric_,
                                          control_.data(), info_.data());
    if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
    return status == UMFPACK_OK && info_[UMFPACK_RCOND] > singular_rcond;
  }

  void solve(double* rhs) override {
    umfpack_di_wsolve(UMFPACK_A, pattern_.column_start.data(), pattern_.row_index.data(),
                      values_.data(), solution_.data(), rhs, numeric_, control_.data(),
                      info_.data(), int_work_.data(), work_.data());
    std::copy(solution_.begin(), solution_.end(), rhs);
  }

  double factor_nonzeros() const override { return info_[UMFPACK_LNZ] + info_[UMFPACK_UNZ]; }
  double factor_flops() const override { return info_[UMFPACK_FLOPS]; }

 private:
  SymmetricPattern pattern_;
  std::vector<double> solution_;
  std::vector<int> int_work_;
  std::vector<double> work_;
  std::array<double, UMFPACK_CONTROL> control_{};
  std::array<double, UMFPACK_INFO> info_{};
  void* symbolic_ = nullptr;
  void* numeric_ = nullptr;
};

class TridiagonalLuSolver final : public DirectSolver {
 public:
  explicit TridiagonalLuSolver(int n)
      : DirectSolver(3 * n - 2), n_(n), lower_(n), diagonal_(n), upper_(n), upper2_(n), pivot_(n) {}

  bool factor() override {
    const double* value = values_.data();  // column j: (j-1, j), (j, j), (j+1, j)
    for (int j = 0; j < n_; ++j) {
      if (j > 0) upper_[j - 1] = *value++;
      diagonal_[j] = *value++;
      if (j + 1 < n_) lower_[j] = *value++;
    }
    const double largest = diagonal_.cwiseAbs().maxCoeff();
    int info = 0;
    dgttrf_(&n_, lower_.data(), diagonal_.data(), upper_.data(), upper2_.data(), pivot_.data(),
            &info);
    return info == 0 && diagonal_.allFinite() &&
           diagonal_.cwiseAbs().minCoeff() > singular_rcond * largest;
  }

  void solve(double* rhs) override {
    const int one = 1;
    int info = 0;
    dgttrs_("N", &n_, &one, lower_.data(), diagonal_.data(), upper_.data(), upper2_.data(),
            pivot_.data(), rhs, &n_, &info);
  }

  double factor_nonzeros() const override { return 5.0 * n_; }
  double factor_flops() const override { return 8.0 * n_; }

 private:
  int n_;
  Eigen::VectorXd lower_, diagonal_, upper_, upper2_;
  std::vector<int> pivot_;
};

}  // namespace

std::unique_ptr<DirectSolver> make_lu_solver(SymmetricPattern pattern) {
  if (pattern.chain(1)) return std::make_unique<TridiagonalLuSolver>(pattern.n);
  return std::make_unique<UmfpackSolver>(std::move(pattern));
}

}  // namespace inextensible
