// J W J^T depends on the angles between neighbouring edges alone, which change little in a step, so
// that an old factor is a good preconditioner: a few iterations each solve, of a back-solve and a
// product each. When to factor again is the ski-rental problem (Karlin et al. 1988): iterations
// that a fresh factor would have saved are rent, and when the rent paid comes to the price of a
// factorization, it is bought. The factor is in single precision, good to about four digits of the
// solution, which is what one iteration of conjugate gradients reaches with a fresh one.
#include "lazy_spd_solver.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace inextensible {
namespace {

constexpr int price = 4;             // of a factorization, in iterations (kernels)
constexpr int most_with_old = 8;     // iterations with an old factor before a fresh one takes over
constexpr int most_with_fresh = 60;  // and with that, before the matrix counts as singular

double dot(const std::vector<double>& x, const std::vector<double>& y) {
  return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
}

}  // namespace

LazySpdSolver::LazySpdSolver(SymmetricPattern pattern)
    : pattern_(std::move(pattern)),
      values_(static_cast<std::size_t>(pattern_.entries())),
      kept_(pattern_) {
  for (std::vector<double>* v : {&x_, &residual_, &preconditioned_, &direction_, &image_})
    v->resize(static_cast<std::size_t>(pattern_.n));
}

bool LazySpdSolver::factor_anew() {
  std::copy(values_.begin(), values_.end(), kept_.values());
  kept_.set_least_pivot(least_pivot_);
  has_factor_ = kept_.factor();
  fresh_ = true;
  rent_ = 0;
  return has_factor_;
}

bool LazySpdSolver::factor() {
  if (!has_factor_ || rent_ >= price) return factor_anew();
  fresh_ = false;
  ++skipped_;
  return true;
}

bool LazySpdSolver::solve_within(double tolerance, double* rhs) {
  std::copy_n(rhs, pattern_.n, residual_.data());
  std::fill(x_.begin(), x_.end(), 0.0);
  const double goal = tolerance * std::sqrt(dot(residual_, residual_));
  const auto before = iterations_;
  Outcome outcome = iterate(goal, fresh_ ? most_with_fresh : most_with_old);
  if (outcome == Outcome::slow && !fresh_) {  // from where that came to, with a fresh factor
    --skipped_;
    if (!factor_anew()) return false;
    outcome = iterate(goal, most_with_fresh);
  } else {
    rent_ += std::max(0, static_cast<int>(iterations_ - before) - 1);
  }
  std::copy(x_.begin(), x_.end(), rhs);
  return outcome == Outcome::solved;
}

// y = A x.
void LazySpdSolver::multiply(const std::vector<double>& x, std::vector<double>& y) const {
  std::fill(y.begin(), y.end(), 0.0);
  for (std::size_t j = 0; j < y.size(); ++j) {
    const auto begin = static_cast<std::size_t>(pattern_.column_start[j]);
    const auto end = static_cast<std::size_t>(pattern_.column_start[j + 1]);
    const double xj = x[j];
    double sum = values_[begin] * xj;  // the diagonal comes first
    for (std::size_t i = begin + 1; i < end; ++i) {
      const auto row = static_cast<std::size_t>(pattern_.row_index[i]);
      sum += values_[i] * x[row];
      y[row] += values_[i] * xj;
    }
    y[j] += sum;
  }
}

// Preconditioned conjugate gradients on x_ until |residual_| <= goal.
LazySpdSolver::Outcome LazySpdSolver::iterate(double goal, int most) {
  double last = 0;  // residual . preconditioned of the last iteration
  for (int i = 0;; ++i) {
    const double error = std::sqrt(dot(residual_, residual_));
    if (error <= goal) return Outcome::solved;
    if (!std::isfinite(error)) return Outcome::indefinite;
    if (i == most) return Outcome::slow;
    ++iterations_;
    preconditioned_ = residual_;
    kept_.solve(preconditioned_.data());
    const double next = dot(residual_, preconditioned_);
    if (i == 0) {
      direction_ = preconditioned_;
    } else {
      const double beta = next / last;
      for (std::size_t k = 0; k < direction_.size(); ++k)
        direction_[k] = preconditioned_[k] + beta * direction_[k];
    }
    last = next;
    multiply(direction_, image_);
    const double curvature = dot(direction_, image_);
    if (!(curvature > 0)) return Outcome::indefinite;
    const double step = next / curvature;
    for (std::size_t k = 0; k < x_.size(); ++k) {
      x_[k] += step * direction_[k];
      residual_[k] -= step * image_[k];
    }
  }
}

}  // namespace inextensible
