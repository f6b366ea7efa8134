#include "solvers/linear/multifrontal_cholesky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "solvers/linear/cholmod_symbolic.h"

namespace inextensible {
namespace {

using Distance = std::ptrdiff_t;

constexpr int panel = 8;   // columns eliminated at once
constexpr int target = 4;  // columns updated at once
// Single precision computes a pivot to about seven digits of its diagonal entry; less says nothing.
template <class Real>
constexpr double least_trusted_pivot = sizeof(Real) == sizeof(float) ? 1e-5 : 0;

// ---- Dense steps, all on column-major storage ----
//
// Rows are taken in whole groups of `lanes`, the last one with rows that do not exist: storage has
// room for them, and they hold zeros where they are summed up.

constexpr int vector_bytes = 32;
template <class Real>
constexpr int lanes = vector_bytes / sizeof(Real);
template <class Real>
constexpr int padded(int n) {
  return (n + lanes<Real> - 1) / lanes<Real> * lanes<Real>;
}
// Rows that a panel of K columns and n rows, its triangle's included, has room for.
template <class Real>
constexpr int panel_ld(int K, int n) {
  return padded<Real>(K % lanes<Real> == 0 ? n : n + lanes<Real> - 1);
}

template <class Real, int bytes>
struct VectorOf {
  typedef Real type __attribute__((vector_size(bytes)));
};
template <class Real>
using Lanes = typename VectorOf<Real, vector_bytes>::type;
// memcpy, because numbers in memory are not aligned as vectors are.
template <class Vector, class Real>
void load(const Real* p, Vector& values) {
  std::memcpy(&values, p, sizeof values);
}
template <class Vector, class Real>
void store(const Vector& values, Real* p) {
  std::memcpy(p, &values, sizeof values);
}

// Eliminates the K columns of a panel of n rows: the triangle of K rows, then the rows below, each
// independent of the others. Leaves unit columns of L (their ones are not written) and the pivots.
// false: a pivot is not above its bound.
template <int K, class Real>
bool eliminate(Real* l, Distance ld, int n, const Real* bound, Real* pivots) {
  Real triangle[K][K], inverse[K];  // lower; 1 / pivot
#pragma GCC unroll 8
  for (int c = 0; c < K; ++c) {
#pragma GCC unroll 8
    for (int r = c; r < K; ++r) triangle[r][c] = l[c * ld + r];
  }
#pragma GCC unroll 8
  for (int c = 0; c < K; ++c) {
    const Real d = triangle[c][c];
    if (!(d > bound[c])) return false;  // the negation catches NaN
    pivots[c] = d;
    inverse[c] = 1 / d;
    Real scaled[K];
#pragma GCC unroll 8
    for (int r = c + 1; r < K; ++r) {
      scaled[r] = triangle[r][c];
      l[c * ld + r] = triangle[r][c] *= inverse[c];
    }
#pragma GCC unroll 8
    for (int k = c + 1; k < K; ++k) {
#pragma GCC unroll 8
      for (int r = k; r < K; ++r) triangle[r][k] -= triangle[r][c] * scaled[k];
    }
  }
  for (int i = K; i < n; i += lanes<Real>) {
    Lanes<Real> y[K];  // rows of L D
#pragma GCC unroll 8
    for (int c = 0; c < K; ++c) load(l + c * ld + i, y[c]);
#pragma GCC unroll 8
    for (int c = 0; c < K; ++c) {
#pragma GCC unroll 8
      for (int k = c + 1; k < K; ++k) y[k] -= y[c] * triangle[k][c];
      store(y[c] * inverse[c], l + c * ld + i);
    }
  }
  return true;
}

// J columns of C less those of P D P^T, from row j on, the first of them column j; P is n x K. With
// `begin` C is not read: it begins as zero. Entries above the diagonal are written, never read.
template <int K, int J, bool begin, class Real>
void subtract_columns(const Real* p, Distance ld_p, const Real* d, int n, int j, Real* c,
                      Distance ld_c) {
  Real factor[K][J];
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k) {
#pragma GCC unroll 4
    for (int t = 0; t < J; ++t) factor[k][t] = d[k] * p[k * ld_p + j + t];
  }
  c += j * ld_c;
  for (int i = j / lanes<Real> * lanes<Real>; i < n; i += lanes<Real>) {
    Lanes<Real> sum[J] = {};
#pragma GCC unroll 8
    for (int k = 0; k < K; ++k) {
      Lanes<Real> value;
      load(p + k * ld_p + i, value);
#pragma GCC unroll 4
      for (int t = 0; t < J; ++t) sum[t] += value * factor[k][t];
    }
#pragma GCC unroll 4
    for (int t = 0; t < J; ++t) {
      Lanes<Real> before = {};
      if (!begin) load(c + t * ld_c + i, before);
      store(before - sum[t], c + t * ld_c + i);
    }
  }
}

// The first m columns of the lower triangle of C (n rows) less those of P D P^T.
template <int K, bool begin, class Real>
void subtract_product(const Real* p, Distance ld_p, const Real* d, int n, int m, Real* c,
                      Distance ld_c) {
  int j = 0;
  for (; j + target <= m; j += target)
    subtract_columns<K, target, begin>(p, ld_p, d, n, j, c, ld_c);
  for (; j < m; ++j) subtract_columns<K, 1, begin>(p, ld_p, d, n, j, c, ld_c);
}

// Where the panel that begins at column k lies among a front's panels, of `rows` rows: they lie one
// after the other, each without the rows above its own.
template <class Real>
Distance panel_at(int rows, int k) {
  return Distance{k} * (padded<Real>(rows) - (k - panel) / 2);
}

// A front on its way: `own` columns of `rows` rows, in panels, and the update matrix of the rows
// below them, of padded(rows - own) rows and columns, which the first panel begins.
template <class Real>
struct Trapezoid {
  Real* columns;
  int rows, own;
  Real* update;
};

// The panel of K columns at column k: eliminated, and taken from the own columns right of it and
// from the update matrix.
template <int K, class Real>
bool take_panel(const Trapezoid<Real>& front, int k, const Real* bound, Real* pivots) {
  const int n = front.rows - k, below = front.rows - front.own;
  const Distance ld = panel_ld<Real>(K, n);
  Real* l = front.columns + panel_at<Real>(front.rows, k);
  if (!eliminate<K>(l, ld, n, bound, pivots)) return false;
  if constexpr (K == panel) {
    for (int r = k + panel; r < front.own; r += panel) {
      const int width = std::min(panel, front.own - r), rows = front.rows - r;
      subtract_product<K, false>(l + (r - k), ld, pivots, rows, width,
                                 front.columns + panel_at<Real>(front.rows, r),
                                 Distance{panel_ld<Real>(width, rows)});
    }
  }
  const Real* p = l + (front.own - k);
  const int all = padded<Real>(below);
  if (k == 0) {
    subtract_product<K, true>(p, ld, pivots, below, all, front.update, all);
  } else {
    subtract_product<K, false>(p, ld, pivots, below, all, front.update, all);
  }
  return true;
}

// Right-hand sides have rows of one number, or of four: the factor is read once for three of them.
template <class Real>
using Four = typename VectorOf<Real, 4 * sizeof(Real)>::type;

// In single precision a vector has room for two rows of four numbers, four rows apart, so that a
// factor's number gets to its row within its half of a vector.
struct TwoRows {
  using Vector = Lanes<float>;
  using Row = Four<float>;
  static Vector from(const float* w) {
    Row first, second;
    load(w, first);
    load(w + 16, second);
    return __builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7);
  }
  static Row first(const Vector& v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
  static Row second(const Vector& v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }
  template <int p>
  static Vector spread(const Vector& column) {
    return __builtin_shufflevector(column, column, p, p, p, p, 4 + p, 4 + p, 4 + p, 4 + p);
  }
};

// Takes K columns times x from the rows w below them.
template <int K>
void subtract_from_below(const float* l, Distance ld, int n, const TwoRows::Row* x, float* w) {
  TwoRows::Vector twice[K];
#pragma GCC unroll 8
  for (int c = 0; c < K; ++c)
    twice[c] = __builtin_shufflevector(x[c], x[c], 0, 1, 2, 3, 0, 1, 2, 3);
  for (int i = K; i < n; i += 8) {
    TwoRows::Vector sum[4];
#pragma GCC unroll 4
    for (int p = 0; p < 4; ++p) sum[p] = TwoRows::from(w + 4 * (i + p));
#pragma GCC unroll 8
    for (int c = 0; c < K; ++c) {
      TwoRows::Vector column;
      load(l + c * ld + i, column);
      sum[0] -= TwoRows::spread<0>(column) * twice[c];
      sum[1] -= TwoRows::spread<1>(column) * twice[c];
      sum[2] -= TwoRows::spread<2>(column) * twice[c];
      sum[3] -= TwoRows::spread<3>(column) * twice[c];
    }
#pragma GCC unroll 4
    for (int p = 0; p < 4; ++p) {
      store(TwoRows::first(sum[p]), w + 4 * (i + p));
      store(TwoRows::second(sum[p]), w + 4 * (i + p) + 16);
    }
  }
}

// Takes the columns' products with the rows w below them from x.
template <int K>
void subtract_below(const float* l, Distance ld, int n, const float* w, TwoRows::Row* x) {
  TwoRows::Vector sum[K] = {};
  for (int i = K; i < n; i += 8) {
    TwoRows::Vector value[4];
#pragma GCC unroll 4
    for (int p = 0; p < 4; ++p) value[p] = TwoRows::from(w + 4 * (i + p));
#pragma GCC unroll 8
    for (int c = 0; c < K; ++c) {
      TwoRows::Vector column;
      load(l + c * ld + i, column);
      sum[c] += TwoRows::spread<0>(column) * value[0];
      sum[c] += TwoRows::spread<1>(column) * value[1];
      sum[c] += TwoRows::spread<2>(column) * value[2];
      sum[c] += TwoRows::spread<3>(column) * value[3];
    }
  }
#pragma GCC unroll 8
  for (int c = 0; c < K; ++c) x[c] -= TwoRows::first(sum[c]) + TwoRows::second(sum[c]);
}

// K columns of forward substitution on the front's rows w, each an X: the triangle, then the rows
// below it, single numbers several at once.
template <int K, class X, class Real>
void substitute_forward(const Real* l, Distance ld, int n, Real* w) {
  constexpr bool single = std::is_same_v<X, Real>;
  constexpr int width = single ? 1 : 4, step = single ? lanes<Real> : 1;
  X x[K];
#pragma GCC unroll 8
  for (int c = 0; c < K; ++c) load(w + width * c, x[c]);
#pragma GCC unroll 8
  for (int c = 0; c < K; ++c) {
#pragma GCC unroll 8
    for (int r = c + 1; r < K; ++r) x[r] -= l[c * ld + r] * x[c];
  }
#pragma GCC unroll 8
  for (int c = 0; c < K; ++c) store(x[c], w + width * c);
  if constexpr (std::is_same_v<X, TwoRows::Row>) return subtract_from_below<K>(l, ld, n, x, w);
  for (int i = K; i < n; i += step) {
    std::conditional_t<single, Lanes<Real>, X> sum;
    load(w + width * i, sum);
#pragma GCC unroll 8
    for (int c = 0; c < K; ++c) {
      std::conditional_t<single, Lanes<Real>, Real> column;
      load(l + c * ld + i, column);
      sum -= column * x[c];
    }
    store(sum, w + width * i);
  }
}

// K columns of back substitution: the rows below, as above, then the triangle.
template <int K, class X, class Real>
void substitute_back(const Real* l, Distance ld, int n, Real* w) {
  constexpr int width = std::is_same_v<X, Real> ? 1 : 4;
  X x[K];
#pragma GCC unroll 8
  for (int c = 0; c < K; ++c) load(w + width * c, x[c]);
  if constexpr (std::is_same_v<X, TwoRows::Row>) {
    subtract_below<K>(l, ld, n, w, x);
  } else if constexpr (width == 1) {
    Lanes<Real> sum[K] = {};
    for (int i = K; i < n; i += lanes<Real>) {
      Lanes<Real> value, column;
      load(w + i, value);
#pragma GCC unroll 8
      for (int c = 0; c < K; ++c) {
        load(l + c * ld + i, column);
        sum[c] += column * value;
      }
    }
#pragma GCC unroll 8
    for (int c = 0; c < K; ++c) {
      Real total = 0;
      for (int lane = 0; lane < lanes<Real>; ++lane) total += sum[c][lane];
      x[c] -= total;
    }
  } else {
    for (int i = K; i < n; ++i) {
      X value;
      load(w + width * i, value);
#pragma GCC unroll 8
      for (int c = 0; c < K; ++c) x[c] -= l[c * ld + i] * value;
    }
  }
#pragma GCC unroll 8
  for (int c = K - 1; c >= 0; --c) {
#pragma GCC unroll 8
    for (int r = 0; r < c; ++r) x[r] -= l[r * ld + c] * x[c];
    store(x[c], w + width * c);
  }
}

// The dense steps by the width of their panel, less one.
template <class Real>
struct OfWidth {
  using Substitution = void(const Real* l, Distance ld, int n, Real* w);
  bool (*take_panel)(const Trapezoid<Real>& front, int k, const Real* bound, Real* pivots);
  Substitution *forward, *back, *fours_forward, *fours_back;
};
template <class Real, int... smaller>
constexpr std::array<OfWidth<Real>, panel> of_widths(std::integer_sequence<int, smaller...>) {
  return {
      {{take_panel<smaller + 1, Real>, substitute_forward<smaller + 1, Real, Real>,
        substitute_back<smaller + 1, Real, Real>, substitute_forward<smaller + 1, Four<Real>, Real>,
        substitute_back<smaller + 1, Four<Real>, Real>}...}};
}
template <class Real>
constexpr auto of_width = of_widths<Real>(std::make_integer_sequence<int, panel>());

// ---- CHOLMOD's symbolic analysis ----

struct Analysis : CholmodAnalysis {
  explicit Analysis(const SymmetricPattern& pattern) {
    common.supernodal = CHOLMOD_SUPERNODAL;
    // Supernodes are merged less than CHOLMOD does for its BLAS calls: short loops cost less here,
    // and every zero stored is read again in solve().
    std::ranges::copy(std::array<std::size_t, 3>{4, 8, 16}, common.nrelax);
    std::ranges::copy(std::array{0.5, 0.1, 0.02}, common.zrelax);
    analyze(pattern);
  }
};

// All panels of a front, and where column c of row 0 is among them.
template <class Real>
std::size_t panels_size(int rows, int columns) {
  const int last = (columns - 1) / panel * panel;
  return panel_at<Real>(rows, last) +
         (columns - last) * panel_ld<Real>(columns - last, rows - last);
}
template <class Real>
Distance column_at(int rows, int columns, int c) {
  const int k = c / panel * panel;
  return panel_at<Real>(rows, k) +
         Distance{c - k} * panel_ld<Real>(std::min(panel, columns - k), rows - k) - k;
}

std::size_t square(std::size_t n) { return n * n; }

}  // namespace

template <class Real>
MultifrontalCholesky<Real>::MultifrontalCholesky(SymmetricPattern pattern)
    : SpdSolver(pattern.entries()), pattern_(std::move(pattern)), pivots_(pattern_.n) {
  if (pattern_.triangle != SymmetricPattern::Triangle::lower)
    throw std::invalid_argument("multifrontal reads the lower triangle");
  find_fronts();
  place_entries();
  link_fronts();
  place_updates();
}

template <class Real>
void MultifrontalCholesky<Real>::find_fronts() {
  const Analysis analysis(pattern_);
  const cholmod_factor& f = *analysis.l;
  const auto* super = static_cast<const int*>(f.super);
  const auto* start = static_cast<const int*>(f.pi);
  const auto* row = static_cast<const int*>(f.s);
  const auto* count = static_cast<const int*>(f.ColCount);
  for (int column = 0; column < pattern_.n; ++column) {
    nonzeros_ += count[column];
    flops_ += static_cast<double>(square(count[column]));
  }
  std::size_t factor_size = 0;
  int most_rows = 0;
  for (std::size_t s = 0; s < f.nsuper; ++s) {
    Front front{};
    front.first_column = super[s];
    front.columns = super[s + 1] - super[s];
    front.rows = start[s + 1] - start[s];
    front.rows_at = rows_.size();
    front.factor_at = factor_size;
    factor_size += panels_size<Real>(front.rows, front.columns);
    rows_.insert(rows_.end(), row + start[s] + front.columns, row + start[s + 1]);
    most_rows = std::max(most_rows, front.rows);
    fronts_.push_back(front);
  }
  factor_.resize(factor_size + lanes<Real>);  // groups of rows below may begin anywhere
  front_rows_.resize(4 * (most_rows + lanes<Real>));
  if constexpr (!std::is_same_v<Real, double>) rounded_.resize(4 * pattern_.n);
}

template <class Real>
void MultifrontalCholesky<Real>::place_entries() {
  entry_place_.resize(values_.size());
  for (Front& front : fronts_) {
    const int end = front.first_column + front.columns;
    front.entries_begin = pattern_.column_start[front.first_column];
    front.entries_end = pattern_.column_start[end];
    for (int column = front.first_column; column < end; ++column) {
      const Distance base = column_at<Real>(front.rows, front.columns, column - front.first_column);
      for (int e = pattern_.column_start[column]; e < pattern_.column_start[column + 1]; ++e)
        entry_place_[e] = static_cast<int>(base + place_in(front, pattern_.row_index[e]));
    }
  }
}

template <class Real>
int MultifrontalCholesky<Real>::place_in(const Front& front, int row) const {
  if (row < front.first_column + front.columns) return row - front.first_column;
  const auto begin = rows_.begin() + static_cast<Distance>(front.rows_at);
  return front.columns +
         static_cast<int>(std::lower_bound(begin, begin + front.below(), row) - begin);
}

template <class Real>
void MultifrontalCholesky<Real>::link_fronts() {
  std::vector<int> front_of(pattern_.n);
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    for (int c = 0; c < fronts_[f].columns; ++c)
      front_of[fronts_[f].first_column + c] = static_cast<int>(f);
  }
  std::vector<std::vector<int>> children(fronts_.size());
  parent_place_.resize(rows_.size());
  for (std::size_t f = fronts_.size(); f-- > 0;) {  // parents come later: from the roots down
    Front& front = fronts_[f];
    if (front.below() == 0) continue;
    const int parent = front_of[rows_[front.rows_at]];
    children[parent].push_back(static_cast<int>(f));
    front.stack = 1 - fronts_[parent].stack;
    const int parent_columns = fronts_[parent].columns;
    for (int i = 0; i < front.below(); ++i) {
      const int place = place_in(fronts_[parent], rows_[front.rows_at + i]);
      parent_place_[front.rows_at + i] = place;
      front.own_of_parent += place < parent_columns;
    }
  }
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    fronts_[f].children_begin = static_cast<int>(children_.size());
    children_.insert(children_.end(), children[f].begin(), children[f].end());
    fronts_[f].children_end = static_cast<int>(children_.size());
  }
}

// In a postorder a front's children are the last ones on their stack. In another order every update
// matrix has a place of its own.
template <class Real>
void MultifrontalCholesky<Real>::place_updates() {
  std::size_t top[2] = {0, 0}, most[2] = {0, 0};
  bool postordered = true;
  for (Front& front : fronts_) {
    front.update_at = top[front.stack];
    top[front.stack] += square(padded<Real>(front.below()));
    most[front.stack] = std::max(most[front.stack], top[front.stack]);
    std::size_t dropped = 0, lowest = top[1 - front.stack];
    for (int c = front.children_begin; c < front.children_end; ++c) {
      const Front& child = fronts_[children_[c]];
      dropped += square(padded<Real>(child.below()));
      lowest = std::min(lowest, child.update_at);
    }
    postordered = postordered && top[1 - front.stack] - lowest == dropped;
    top[1 - front.stack] = lowest;
  }
  if (!postordered) {
    most[0] = most[1] = 0;
    for (Front& front : fronts_) {
      front.update_at = most[front.stack];
      most[front.stack] += square(padded<Real>(front.below()));
    }
  }
  for (const int i : {0, 1}) updates_[i].resize(most[i]);
}

template <class Real>
bool MultifrontalCholesky<Real>::factor() {
  for (const Front& front : fronts_) {
    Real* columns = factor_.data() + front.factor_at;
    Real* update = updates_[front.stack].data() + front.update_at;
    std::fill_n(columns, panels_size<Real>(front.rows, front.columns), Real{0});
    for (int e = front.entries_begin; e < front.entries_end; ++e)
      columns[entry_place_[e]] = static_cast<Real>(values_[e]);
    const int* const children_end = children_.data() + front.children_end;
    const int* const children = children_.data() + front.children_begin;
    for (const int* c = children; c < children_end; ++c) {
      const Front& child = fronts_[*c];
      add_update(child, 0, child.own_of_parent, [&](int place) {
        return columns + column_at<Real>(front.rows, front.columns, place);
      });
    }
    if (!eliminate_columns(front, columns, update)) return false;
    for (const int* c = children; c < children_end; ++c) {
      const Front& child = fronts_[*c];
      add_update(child, child.own_of_parent, child.below(), [&](int place) {
        return update + (place - front.columns) * Distance{padded<Real>(front.below())} -
               front.columns;
      });
    }
  }
  return true;
}

// Columns [begin, end) of a child's update matrix, to where into(row of the parent's front) begins.
template <class Real>
template <class Into>
void MultifrontalCholesky<Real>::add_update(const Front& child, int begin, int end,
                                            Into into) const {
  const int* place = parent_place_.data() + child.rows_at;
  const int below = child.below();
  const Distance ld = padded<Real>(below);
  const Real* from = updates_[child.stack].data() + child.update_at + begin * ld;
  for (int c = begin; c < end; ++c, from += ld) {
    Real* column = into(place[c]);
#pragma GCC unroll 4
    for (int i = c; i < below; ++i) column[place[i]] += from[i];
  }
}

template <class Real>
bool MultifrontalCholesky<Real>::eliminate_columns(const Front& front, Real* columns,
                                                   Real* update) {
  Real bound[panel];
  const double least = std::max(least_pivot_, least_trusted_pivot<Real>);
  for (int k = 0; k < front.columns; k += panel) {
    const int width = std::min(panel, front.columns - k), column = front.first_column + k;
    for (int c = 0; c < width; ++c)
      bound[c] = static_cast<Real>(least * values_[pattern_.diagonal(column + c)]);
    if (!of_width<Real>[width - 1].take_panel({columns, front.rows, front.columns, update}, k,
                                              bound, pivots_.data() + column))
      return false;
  }
  return true;
}

template <class Real>
void MultifrontalCholesky<Real>::solve(double* rhs) {
  if constexpr (std::is_same_v<Real, double>) {
    substitute<1>(rhs);
  } else {  // scaled, so that no magnitude is out of range
    double largest = 0;
    for (int i = 0; i < pattern_.n; ++i) largest = std::max(largest, std::abs(rhs[i]));
    if (!(largest > 0)) return;
    for (int i = 0; i < pattern_.n; ++i) rounded_[i] = static_cast<Real>(rhs[i] / largest);
    substitute<1>(rounded_.data());
    for (int i = 0; i < pattern_.n; ++i) rhs[i] = largest * double{rounded_[i]};
  }
}

template <class Real>
void MultifrontalCholesky<Real>::solve_coordinates(Eigen::Matrix4Xd& rhs) {
  if constexpr (std::is_same_v<Real, double>) {
    substitute<4>(rhs.data());
  } else {
    Eigen::Map<Eigen::Matrix4X<Real>> rounded(rounded_.data(), 4, pattern_.n);
    const double largest = rhs.cwiseAbs().maxCoeff();
    if (!(largest > 0)) return;
    rounded = (rhs * (1 / largest)).template cast<Real>();
    substitute<4>(rounded_.data());
    rhs = largest * rounded.template cast<double>();
  }
}

template <class Real>
template <int width>
void MultifrontalCholesky<Real>::substitute(Real* rhs) {
  using Steps = OfWidth<Real>;
  using Row = std::conditional_t<width == 1, Real, Four<Real>>;
  const auto row_at = [](const Real* first, int i) {
    Row row;
    load(first + width * i, row);
    return row;
  };
  constexpr auto forward = width == 1 ? &Steps::forward : &Steps::fours_forward,
                 back = width == 1 ? &Steps::back : &Steps::fours_back;
  Real* const w = front_rows_.data();
  const auto take_panel_at = [&](const Front& front, int k, auto direction) {
    const int columns = std::min(panel, front.columns - k), rows = front.rows - k;
    (of_width<Real>[columns - 1].*direction)(
        factor_.data() + front.factor_at + panel_at<Real>(front.rows, k),
        panel_ld<Real>(columns, rows), rows, w + width * k);
  };
  // Counts are copied: stores of vectors might change anything else, as far as a compiler knows.
  for (const Front& front : fronts_) {  // L y = rhs
    const int columns = front.columns, rows_below = front.below();
    const int* row = rows_.data() + front.rows_at;
    Real* const x = rhs + width * front.first_column;
    Real* const below = w + width * columns;
    for (int i = 0; i < columns; ++i) store(row_at(x, i), w + width * i);
    for (int i = 0; i < rows_below; ++i) store(Row{}, below + width * i);
    for (int k = 0; k < columns; k += panel) take_panel_at(front, k, forward);
    for (int i = 0; i < columns; ++i) store(row_at(w, i), x + width * i);
    for (int i = 0; i < rows_below; ++i)
      store(row_at(rhs, row[i]) + row_at(below, i), rhs + width * row[i]);
  }
  for (int i = 0; i < pattern_.n; ++i) store(row_at(rhs, i) / pivots_[i], rhs + width * i);
  for (std::size_t f = fronts_.size(); f-- > 0;) {  // L^T x = D^-1 y
    const Front& front = fronts_[f];
    const int columns = front.columns, rows_below = front.below();
    const int* row = rows_.data() + front.rows_at;
    Real* const x = rhs + width * front.first_column;
    Real* const below = w + width * columns;
    for (int i = 0; i < columns; ++i) store(row_at(x, i), w + width * i);
    for (int i = 0; i < rows_below; ++i) store(row_at(rhs, row[i]), below + width * i);
    for (int i = 0; i < lanes<Real>; ++i) store(Row{}, below + width * (rows_below + i));
    for (int k = (columns - 1) / panel * panel; k >= 0; k -= panel) take_panel_at(front, k, back);
    for (int i = 0; i < columns; ++i) store(row_at(w, i), x + width * i);
  }
}

template <class Real>
double MultifrontalCholesky<Real>::least_relative_pivot() const {
  double least = 1;
  for (int i = 0; i < pattern_.n; ++i) {
    const double diagonal = values_[pattern_.diagonal(i)];
    least = std::min(least, double{pivots_[i]} / diagonal);
  }
  return least;
}

template class MultifrontalCholesky<double>;
template class MultifrontalCholesky<float>;

}  // namespace inextensible
