// L D L^T of a symmetric tridiagonal matrix (Golub and Van Loan, Matrix Computations, section
// 4.3.6): O(n), no pivoting. Every pivot waits for the division of the one before it: some twenty
// cycles a row. So rows are eliminated from both ends at once, two such chains side by side, and
// the row in the middle last (twisted: van der Vorst 1987). This is L D L^T with the rows in
// another order, hence as stable. Loops: one over pairs of rows to factor, two to solve.
//
// The block solver is the same with 3 x 3 blocks for numbers: the springs of a chain, a rope, a
// hair. Let A be a row's diagonal block less what it has lost to rows eliminated before it, and B
// its coupling to the next row. With A = L D L^T and Z = D^-1 L^-1 B the next row loses B^T A^-1 B
// = Z^T D Z. Blocks are spelled out as numbers: as arrays they take three times as long (measured).
#include <algorithm>
#include <stdexcept>

#include "solvers/linear/spd_solver.h"

namespace inextensible {
namespace {

// pivot(row, lost): false if it is not positive. down(row), up(row): eliminate a row towards the
// last or the first one, and return what that one's neighbour loses.
template <class Lost, class Pivot, class Down, class Up>
bool eliminate_from_both_ends(std::size_t rows, Pivot pivot, Down down, Up up) {
  std::size_t i = 0, j = rows - 1;
  Lost from_above{}, from_below{};  // lost by rows i and j
  for (; i + 1 < j; ++i, --j) {
    if (!pivot(i, from_above) || !pivot(j, from_below)) return false;
    from_above = down(i);
    from_below = up(j);
  }
  if (i < j) {  // an even number of rows: one more from above
    if (!pivot(i, from_above)) return false;
    from_above = down(i);
  }
  return pivot(j, from_above + from_below);
}

// The values are d_0, (e_1, d_1), (e_2, d_2), ...
class TridiagonalSolver final : public SpdSolver {
 public:
  explicit TridiagonalSolver(const SymmetricPattern& pattern)
      : SpdSolver(pattern.entries()), n_(pattern.n), l_(n_), inverse_d_(n_) {
    if (!pattern.chain(1) || pattern.triangle != SymmetricPattern::Triangle::upper)
      throw std::invalid_argument(
          "the linear solver 'tridiagonal' needs constraints that form one chain in order");
  }

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
    return eliminate_from_both_ends<double>(
        n_, pivot, [&](std::size_t i) { return eliminate(i, i + 1); },
        [&](std::size_t j) { return eliminate(j, j); });
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

  double factor_nonzeros() const override { return 2.0 * static_cast<double>(n_) - 1; }
  double factor_flops() const override { return 3.0 * static_cast<double>(n_); }

 private:
  std::size_t n_;
  std::vector<double> l_;  // the factor's entry between rows i - 1 and i, i from 1 on
  std::vector<double> inverse_d_;
};

struct Vector {
  double x, y, z;
};
Vector load(const double* p) { return {p[0], p[1], p[2]}; }
void store(Vector v, double* p) { p[0] = v.x, p[1] = v.y, p[2] = v.z; }

struct SymmetricBlock {
  double xx, xy, yy, xz, yz, zz;
};
SymmetricBlock operator+(const SymmetricBlock& a, const SymmetricBlock& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy, a.xz + b.xz, a.yz + b.yz, a.zz + b.zz};
}

// Among the values, row 0 has the 6 numbers of its diagonal block's upper triangle, every other row
// three columns of 4, 5 and 6: one of the coupling to the row before, then one of the triangle.
const double* row_values(const double* values, std::size_t row) { return values + 15 * row - 9; }

SymmetricBlock diagonal(const double* values, std::size_t row) {
  if (row == 0) return {values[0], values[1], values[2], values[3], values[4], values[5]};
  const double* v = row_values(values, row);
  return {v[3], v[7], v[8], v[12], v[13], v[14]};
}

struct Row {
  double l10, l20, l21;  // of L
  double i0, i1, i2;     // D^-1
  double z00, z01, z02, z10, z11, z12, z20, z21, z22;

  // false: a pivot is not above `least` times its diagonal entry of a.
  bool pivot(const SymmetricBlock& a, const SymmetricBlock& lost, double least) {
    const double d0 = a.xx - lost.xx, b10 = a.xy - lost.xy, b20 = a.xz - lost.xz;
    i0 = 1 / d0;
    l10 = b10 * i0;
    l20 = b20 * i0;
    const double d1 = a.yy - lost.yy - l10 * b10, b21 = a.yz - lost.yz - l20 * b10;
    i1 = 1 / d1;
    l21 = b21 * i1;
    const double d2 = a.zz - lost.zz - l20 * b20 - l21 * b21;
    i2 = 1 / d2;
    return d0 > least * a.xx && d1 > least * a.yy && d2 > least * a.zz;  // false for NaN
  }

  // b(r, c): the coupling to the next row. Returns what that row loses.
  template <class Coupling>
  SymmetricBlock eliminate(Coupling b) {
    const double w00 = b(0, 0), w01 = b(0, 1), w02 = b(0, 2);  // L^-1 B
    const double w10 = b(1, 0) - l10 * w00, w20 = b(2, 0) - l20 * w00 - l21 * w10;
    const double w11 = b(1, 1) - l10 * w01, w21 = b(2, 1) - l20 * w01 - l21 * w11;
    const double w12 = b(1, 2) - l10 * w02, w22 = b(2, 2) - l20 * w02 - l21 * w12;
    z00 = i0 * w00, z01 = i0 * w01, z02 = i0 * w02;
    z10 = i1 * w10, z11 = i1 * w11, z12 = i1 * w12;
    z20 = i2 * w20, z21 = i2 * w21, z22 = i2 * w22;
    return {z00 * w00 + z10 * w10 + z20 * w20, z00 * w01 + z10 * w11 + z20 * w21,
            z01 * w01 + z11 * w11 + z21 * w21, z00 * w02 + z10 * w12 + z20 * w22,
            z01 * w02 + z11 * w12 + z21 * w22, z02 * w02 + z12 * w12 + z22 * w22};
  }

  Vector lower_solve(Vector b) const {  // L^-1 b
    b.y -= l10 * b.x;
    b.z -= l20 * b.x + l21 * b.y;
    return b;
  }
  Vector upper_solve(Vector y) const {  // L^-T y
    y.y -= l21 * y.z;
    y.x -= l20 * y.z + l10 * y.y;
    return y;
  }
  Vector scaled(Vector y) const { return {i0 * y.x, i1 * y.y, i2 * y.z}; }
  // The next row's right-hand side b less what it loses to this one's y = L^-1 b.
  Vector reduce(Vector b, Vector y) const {
    return {b.x - z00 * y.x - z10 * y.y - z20 * y.z, b.y - z01 * y.x - z11 * y.y - z21 * y.z,
            b.z - z02 * y.x - z12 * y.y - z22 * y.z};
  }
  // This row's solution, from its y and the next row's solution x.
  Vector substitute(Vector y, Vector x) const {
    return upper_solve({i0 * y.x - z02 * x.z - z01 * x.y - z00 * x.x,
                        i1 * y.y - z12 * x.z - z11 * x.y - z10 * x.x,
                        i2 * y.z - z22 * x.z - z21 * x.y - z20 * x.x});
  }
};

class BlockTridiagonalSolver final : public SpdSolver {
 public:
  explicit BlockTridiagonalSolver(const SymmetricPattern& pattern)
      : SpdSolver(pattern.entries()), rows_(pattern.n / 3) {
    if (!pattern.chain(3) || pattern.triangle != SymmetricPattern::Triangle::upper)
      throw std::invalid_argument(
          "the linear solver 'block_tridiagonal' needs vertices that form one chain in order");
  }

  bool factor() override {
    static constexpr std::size_t column[3] = {0, 4, 9};  // of row_values
    const double* values = values_.data();
    const auto pivot = [&](std::size_t row, const SymmetricBlock& lost) {
      return rows_[row].pivot(diagonal(values, row), lost, least_pivot_);
    };
    const auto eliminate_downwards = [&](std::size_t row) {
      const double* v = row_values(values, row + 1);
      return rows_[row].eliminate([v](std::size_t r, std::size_t c) { return v[column[c] + r]; });
    };
    const auto eliminate_upwards = [&](std::size_t row) {  // the stored block transposed
      const double* v = row_values(values, row);
      return rows_[row].eliminate([v](std::size_t r, std::size_t c) { return v[column[r] + c]; });
    };
    return eliminate_from_both_ends<SymmetricBlock>(rows_.size(), pivot, eliminate_downwards,
                                                    eliminate_upwards);
  }

  void solve(double* rhs) override {
    std::size_t i = 0, j = rows_.size() - 1;
    Vector above = load(rhs + 3 * i), below = load(rhs + 3 * j);
    const auto eliminate_above = [&] {
      above = rows_[i].lower_solve(above);
      store(above, rhs + 3 * i);
    };
    const auto eliminate_below = [&] {
      below = rows_[j].lower_solve(below);
      store(below, rhs + 3 * j);
    };
    for (; i + 2 < j; ++i, --j) {
      eliminate_above();
      eliminate_below();
      above = rows_[i].reduce(load(rhs + 3 * (i + 1)), above);
      below = rows_[j].reduce(load(rhs + 3 * (j - 1)), below);
    }
    if (i < j) eliminate_above();
    if (i + 2 == j) {  // one row is left between them
      eliminate_below();
      below = rows_[j].reduce(load(rhs + 3 * (j - 1)), below);
      --j;
    }
    if (i < j) below = rows_[i].reduce(below, above);
    const Row& last = rows_[j];
    above = below = last.upper_solve(last.scaled(last.lower_solve(below)));
    store(below, rhs + 3 * j);
    const auto substitute = [&](std::size_t row, Vector& x) {
      x = rows_[row].substitute(load(rhs + 3 * row), x);
      store(x, rhs + 3 * row);
    };
    i = j;
    if (2 * j == rows_.size()) substitute(--i, above);  // an even number of rows: one more above
    while (i > 0) {
      substitute(--i, above);
      substitute(++j, below);
    }
  }

  double factor_nonzeros() const override { return static_cast<double>(values_.size()); }
  // The sum of squared column counts: 6, 5 and 4 in each row but the last.
  double factor_flops() const override {
    return 77.0 * (static_cast<double>(rows_.size()) - 1) + 14;
  }

 private:
  std::vector<Row> rows_;
};

}  // namespace

std::unique_ptr<SpdSolver> make_tridiagonal(SymmetricPattern pattern) {
  return std::make_unique<TridiagonalSolver>(pattern);
}

std::unique_ptr<SpdSolver> make_block_tridiagonal(SymmetricPattern pattern) {
  return std::make_unique<BlockTridiagonalSolver>(pattern);
}

}  // namespace inextensible
