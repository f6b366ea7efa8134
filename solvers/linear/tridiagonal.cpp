// L D L^T of a symmetric tridiagonal matrix (Golub and Van Loan, Matrix Computations,
// section 4.3.6): O(n), no pivoting. Every pivot waits for the division of the one before it: some
// twenty cycles a row. So rows are eliminated from both ends at once, two such chains side by side,
// and the row in the middle last (twisted: van der Vorst 1987). This is L D L^T of the matrix with
// its rows in another order, hence as stable. Loops: one over pairs of rows to factor, two to
// solve.
#include <algorithm>
#include <memory>
#include <stdexcept>

#include "solvers/linear/spd_solver.h"

namespace inextensible {
namespace {

class TridiagonalSolver final : public SpdSolver {
 public:
  explicit TridiagonalSolver(const SymmetricPattern& pattern)
      : n_(pattern.n), values_(pattern.entries()), l_(n_), inverse_d_(n_) {
    if (!pattern.chain(1) || pattern.triangle != SymmetricPattern::Triangle::upper) {
      throw std::invalid_argument(
          "the linear solver 'tridiagonal' needs constraints that form one chain in order");
    }
  }
  double* values() override { return values_.data(); }

  bool factor() override {
    const auto pivot = [&](std::size_t row, double lost) {
      const double a = values_[2 * row], d = a - lost;
      inverse_d_[row] = 1 / d;
      return d > least_pivot_ * a;  // false for NaN
    };
    // Eliminates row `from`, a neighbour of row `pair` - 1 or `pair`, and returns what the other of
    // the two loses on its diagonal.
    const auto eliminate = [&](std::size_t from, std::size_t pair) {
      const double e = values_[2 * pair - 1];
      l_[pair] = e * inverse_d_[from];
      return l_[pair] * e;
    };
    std::size_t i = 0, j = n_ - 1;
    double from_above = 0, from_below = 0;  // lost by rows i and j
    for (; i + 1 < j; ++i, --j) {
      if (!pivot(i, from_above) || !pivot(j, from_below)) return false;
      from_above = eliminate(i, i + 1);
      from_below = eliminate(j, j);
    }
    if (i < j) {  // an even number of rows: one more from above
      if (!pivot(i, from_above)) return false;
      from_above = eliminate(i, j);
    }
    return pivot(j, from_above + from_below);
  }

  void solve(double* rhs) override {
    std::size_t i = 0, j = n_ - 1;
    double above = rhs[i], below = rhs[j];
    while (i + 2 < j) {
      ++i, --j;
      rhs[i] = above = rhs[i] - l_[i] * above;
      rhs[j] = below = rhs[j] - l_[j + 1] * below;
    }
    if (i + 2 == j) {  // one row is left between them
      --j;
      rhs[j] -= l_[j] * above + l_[j + 1] * below;
    } else if (i < j) {
      rhs[j] -= l_[j] * above;
    }
    above = below = rhs[j] *= inverse_d_[j];
    i = j;
    if (2 * j == n_) {  // an even number of rows: one more above
      --i;
      rhs[i] = above = rhs[i] * inverse_d_[i] - l_[j] * above;
    }
    while (i > 0) {
      --i, ++j;
      rhs[i] = above = rhs[i] * inverse_d_[i] - l_[i + 1] * above;
      rhs[j] = below = rhs[j] * inverse_d_[j] - l_[j] * below;
    }
  }

  double reciprocal_condition() const override {
    const auto [low, high] = std::minmax_element(inverse_d_.begin(), inverse_d_.end());
    return *low / *high;
  }

  double factor_nonzeros() const override { return 2.0 * static_cast<double>(n_) - 1; }
  double factor_flops() const override { return 3.0 * static_cast<double>(n_); }

 private:
  std::size_t n_;
  std::vector<double> values_;  // upper triangle: d_0, (e_1, d_1), (e_2, d_2), ...
  std::vector<double> l_;       // the factor's entry between rows i - 1 and i, i from 1 on
  std::vector<double> inverse_d_;
};

}  // namespace

std::unique_ptr<SpdSolver> make_tridiagonal(SymmetricPattern pattern) {
  return std::make_unique<TridiagonalSolver>(pattern);
}

}  // namespace inextensible
