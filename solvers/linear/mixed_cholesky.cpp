#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "solvers/linear/multifrontal_cholesky.h"

namespace inextensible {
namespace {

// The residual after one solve, relative to the right-hand side, is some roundings times the
// condition of the matrix scaled to a unit diagonal, of which the pivots are an estimate.
constexpr double roundings = 4 * std::numeric_limits<float>::epsilon();
constexpr double five_digits = 1e-5;
constexpr int most_refinements = 6;  // each gains more than two digits, or the factor is useless

double norm(const std::vector<double>& v) {
  return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0));
}

}  // namespace

MixedCholesky::MixedCholesky(SymmetricPattern pattern)
    : pattern_(std::move(pattern)),
      single_(pattern_),
      double_(pattern_),
      rhs_(pattern_.n),
      residual_(rhs_.size()) {}

bool MixedCholesky::factor() {
  single_.set_least_pivot(least_pivot_);
  in_double_ = !single_.factor();
  if (in_double_) return factor_in_double();
  accuracy_ = roundings / single_.least_relative_pivot();
  return true;
}

bool MixedCholesky::factor_in_double() {
  in_double_ = true;
  std::copy_n(single_.values(), pattern_.entries(), double_.values());
  double_.set_least_pivot(least_pivot_);
  return double_.factor();
}

bool MixedCholesky::solve_within(double tolerance, double* rhs) {
  if (!in_double_) {
    const bool enough = accuracy_ <= tolerance;
    if (!enough) std::copy_n(rhs, pattern_.n, rhs_.data());
    single_.solve(rhs);
    if (enough || refine(tolerance, rhs)) return true;
    std::copy_n(rhs_.data(), pattern_.n, rhs);
    if (!factor_in_double()) return false;
  }
  double_.solve(rhs);
  return true;
}

void MixedCholesky::solve_coordinates(Eigen::Matrix4Xd& rhs) {
  if (!in_double_ && !(accuracy_ <= five_digits)) in_double_ = factor_in_double();
  in_double_ ? double_.solve_coordinates(rhs) : single_.solve_coordinates(rhs);
}

bool MixedCholesky::refine(double tolerance, double* x) {
  const double wanted = tolerance * norm(rhs_);
  for (int i = 0;; ++i) {
    std::copy(rhs_.begin(), rhs_.end(), residual_.begin());
    subtract_product(x);
    if (norm(residual_) <= wanted) return true;
    if (i == most_refinements) return false;
    single_.solve(residual_.data());
    for (std::size_t k = 0; k < residual_.size(); ++k) x[k] += residual_[k];
  }
}

// residual - A x, A by its lower triangle.
void MixedCholesky::subtract_product(const double* x) {
  const double* value = single_.values();
  for (int column = 0; column < pattern_.n; ++column) {
    int e = pattern_.column_start[column];
    double sum = value[e] * x[column];  // the diagonal entry comes first
    for (++e; e < pattern_.column_start[column + 1]; ++e) {
      const int row = pattern_.row_index[e];
      residual_[row] -= value[e] * x[column];
      sum += value[e] * x[row];
    }
    residual_[column] -= sum;
  }
}

}  // namespace inextensible
