// Rows of J W J^T are edges, and two edges couple by the cosine between them: strongly along a
// yarn, where they are collinear, weakly across. So the matrix is tridiagonal along each yarn,
// with the condition of a chain, ~ length^2; and between warp and weft it adds little as long as
// the cloth is not sheared. With one family of yarns (warp, say) called A, the other B,
//
//   [ T_A  C^T ] [x_A]   [b_A]      T_A, T_B: tridiagonal line by line,
//   [ C    T_B ] [x_B] = [b_B],     C: where yarns cross.
//
// The block preconditioner diag(T_A, T_B) is exact along yarns. At a crossing of the angle g the
// weighted force of both yarns satisfies |a e_1 + b e_2|^2 >= (1 - |cos g|) (a^2 + b^2), so that
// on flat cloth the condition is at most (1 + |cos g|) / (1 - |cos g|), whatever the number of
// vertices; curvature adds a factor of the same kind. Half of the iterations are saved by
// eliminating A, which costs no more than preconditioning with it (Reid 1972; Concus, Golub and
// O'Leary 1976): CG, preconditioned with T_B, for
//
//   (T_B - C T_A^-1 C^T) x_B = b_B - C T_A^-1 b_A.
//
// The residual of the whole system is that of these rows, zeros elsewhere. Any matrix will do:
// lines are paths through strong couplings without chords, A is an independent set of lines, and
// what couples lines of B with each other (R) is added to T_B in the product only.
//
// Iterations to 1e-2 and 1e-8 of the right-hand side, drape of 201 x 201 at 0.2 s (largest |cos g|
// 0.58): this 4 and 12, incomplete Cholesky 6 and 22, the diagonal 275 and 1382. At 0.3 s, where
// warp and weft have become parallel and J W J^T nearly singular: 181 and 1182, 43 and 385 (101 x
// 101); nothing cheap is good there, and hybrid.h factors.
//
// Loops: an iteration reads C twice, the factors of T_A and T_B twice, and six vectors.
#include "solvers/linear/line_cg.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

namespace inextensible {
namespace {

// In units of sqrt(a_kk a_ll): collinear neighbours of one mass and length have 1/2, those at 60
// degrees 1/4.
constexpr double strong = 0.25;

}  // namespace

// Couplings of each row with all others, and up to two of them chosen as its neighbours on a line.
struct LineCgSolver::Graph {
  struct Coupling {
    int row, at;  // at: in values_
  };
  std::vector<int> start;
  std::vector<Coupling> couplings;
  std::vector<int> line;  // of each row: any number that is the same on the whole line
  struct Neighbours {
    int row[2] = {-1, -1}, at[2] = {-1, -1};
    int count() const { return (row[0] >= 0) + (row[1] >= 0); }
    void add(int r, int place) {
      const int i = row[0] >= 0;
      row[i] = r;
      at[i] = place;
    }
    void remove(int r) { row[row[1] == r] = -1; }
  };
  std::vector<Neighbours> neighbours;

  explicit Graph(const SymmetricPattern& pattern)
      : start(pattern.n + 1), line(pattern.n), neighbours(pattern.n) {
    for (int l = 0; l < pattern.n; ++l) {
      for (int i = pattern.column_start[l]; i < pattern.diagonal(l); ++i) {
        ++start[l + 1];
        ++start[pattern.row_index[i] + 1];
      }
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    couplings.resize(start.back());
    std::vector<int> end(start.begin(), start.end() - 1);
    for (int l = 0; l < pattern.n; ++l) {
      for (int i = pattern.column_start[l]; i < pattern.diagonal(l); ++i) {
        const int k = pattern.row_index[i];
        couplings[end[l]++] = {k, i};
        couplings[end[k]++] = {l, i};
      }
    }
  }
  std::span<const Coupling> of(int row) const {
    return {couplings.data() + start[row], couplings.data() + start[row + 1]};
  }
  int root(int row) {
    while (line[row] != row) row = line[row] = line[line[row]];
    return row;
  }
  // Calls visit(row) along every line, from the end of smaller number on.
  template <class Visit>
  void walk(Visit visit) const {
    std::vector<bool> seen(neighbours.size());
    for (int first = 0; first < static_cast<int>(neighbours.size()); ++first) {
      if (seen[first] || neighbours[first].count() == 2) continue;
      for (int row = first, before = -1; row >= 0;) {
        seen[row] = true;
        visit(row, before);
        const auto& [next, unused] = neighbours[row];
        const int on = next[0] >= 0 && next[0] != before ? next[0] : next[1];
        before = std::exchange(row, on == before ? -1 : on);
      }
    }
  }
};

LineCgSolver::LineCgSolver(SymmetricPattern pattern)
    : pattern_(std::move(pattern)), values_(pattern_.entries()) {
  if (pattern_.triangle != SymmetricPattern::Triangle::upper)
    throw std::invalid_argument("the linear solver 'line_cg' reads the upper triangle");
}

// ---- Set-up -------------------------------------------------------------------------------------

void LineCgSolver::find_lines() {
  Graph graph(pattern_);
  join_strongest(graph);
  cut_chords(graph);
  choose_families(graph);
  place_rows(graph);
  place_couplings(graph);
}

// Strongest couplings first, as long as nothing branches and no ring closes.
void LineCgSolver::join_strongest(Graph& graph) const {
  struct Candidate {
    float strength;
    int k, l, at;
  };
  std::vector<Candidate> candidates;
  for (int l = 0; l < pattern_.n; ++l) {
    const double d = values_[pattern_.diagonal(l)];
    for (int i = pattern_.column_start[l]; i < pattern_.diagonal(l); ++i) {
      const int k = pattern_.row_index[i];
      const double scale = std::sqrt(d * values_[pattern_.diagonal(k)]);
      const double strength = std::abs(values_[i]) / scale;
      if (strength >= strong) candidates.push_back({static_cast<float>(strength), k, l, i});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& p, const Candidate& q) { return p.strength > q.strength; });
  std::iota(graph.line.begin(), graph.line.end(), 0);
  for (const auto& [strength, k, l, place] : candidates) {
    if (graph.neighbours[k].count() == 2 || graph.neighbours[l].count() == 2) continue;
    const int i = graph.root(k), j = graph.root(l);
    if (i == j) continue;
    graph.line[i] = j;
    graph.neighbours[k].add(l, place);
    graph.neighbours[l].add(k, place);
  }
}

// A row that is coupled with an earlier one of its line, other than its predecessor, begins a new
// line: the tridiagonal part of a line is then all of its submatrix, and so positive definite.
void LineCgSolver::cut_chords(Graph& graph) const {
  std::vector<int> name(pattern_.n, -1);
  std::vector<std::pair<int, int>> cuts;
  int line = -1;
  graph.walk([&](int row, int before) {
    bool cut = before < 0;
    if (!cut) {
      for (const auto& [other, unused] : graph.of(row))
        cut = cut || (other != before && name[other] == line);
      if (cut) cuts.emplace_back(before, row);
    }
    name[row] = cut ? ++line : line;
  });
  for (const auto& [before, row] : cuts) {
    graph.neighbours[before].remove(row);
    graph.neighbours[row].remove(before);
  }
  graph.line = std::move(name);
}

// A: lines that are not coupled with each other, chosen greedily, those with the fewest couplings
// first (Halldorsson and Radhakrishnan 1997).
void LineCgSolver::choose_families(const Graph& graph) {
  lines_ = 1 + *std::max_element(graph.line.begin(), graph.line.end());
  std::vector<int> couplings(lines_, 0), order(lines_);
  std::vector<std::vector<int>> rows(lines_);
  for (int row = 0; row < pattern_.n; ++row) {
    const int line = graph.line[row];
    couplings[line] += static_cast<int>(graph.of(row).size());
    rows[line].push_back(row);
  }
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int p, int q) { return couplings[p] < couplings[q]; });
  family_of_.assign(pattern_.n, -1);
  for (const int line : order) {
    bool free = true;
    for (const int row : rows[line]) {
      for (const auto& [other, unused] : graph.of(row))
        free = free && (graph.line[other] == line || family_of_[other] != 0);
    }
    for (const int row : rows[line]) family_of_[row] = free ? 0 : 1;
  }
}

void LineCgSolver::place_rows(const Graph& graph) {
  std::vector<int> before(pattern_.n, -1), link(pattern_.n, -1);
  graph.walk([&](int row, int previous) {
    before[row] = previous;
    if (previous < 0) return;
    const auto& near = graph.neighbours[row];
    link[row] = near.at[near.row[1] == previous];
  });
  place_.assign(pattern_.n, -1);
  std::vector<int> chain;
  for (int first = 0; first < pattern_.n; ++first) {
    for (int row = first; row >= 0 && place_[row] < 0; row = before[row]) chain.push_back(row);
    for (; !chain.empty(); chain.pop_back()) {
      const int row = chain.back();
      Family& family = family_of_[row] == 0 ? eliminated_ : kept_;
      place_[row] = family.size();
      family.previous.push_back(before[row] < 0 ? family.size() : place_[before[row]]);
      family.row.push_back(row);
      family.diagonal_at.push_back(pattern_.diagonal(row));
      family.link_at.push_back(link[row]);
    }
  }
  for (Family* family : {&eliminated_, &kept_}) {
    family->inverse_pivot.resize(family->row.size());
    family->link.resize(family->row.size());
  }
}

void LineCgSolver::place_couplings(const Graph& graph) {
  for (Couplings* couplings : {&across_, &among_}) couplings->start.push_back(0);
  for (int k = 0; k < kept_.size(); ++k) {
    const int row = kept_.row[k];
    for (const auto& [other, place] : graph.of(row)) {
      const bool crosses = eliminated(other);
      const int column = place_[other];
      if (!crosses && (column > k || place == kept_.link_at[k])) continue;
      Couplings& couplings = crosses ? across_ : among_;
      couplings.column.push_back(column);
      couplings.at.push_back(place);
    }
    for (Couplings* couplings : {&across_, &among_})
      couplings->start.push_back(static_cast<int>(couplings->column.size()));
  }
  for (Couplings* couplings : {&across_, &among_}) couplings->value.resize(couplings->at.size());
  for (auto* vector : {&solution_, &residual_, &direction_, &line_direction_, &product_})
    vector->resize(kept_.size());
  beyond_.resize(eliminated_.size());
}

// ---- Factorization ------------------------------------------------------------------------------

bool LineCgSolver::factor() {
  if (place_.empty()) find_lines();
  if (!eliminated_.factor(values_.data(), least_pivot_)) return false;
  if (!kept_.factor(values_.data(), least_pivot_)) return false;
  across_.gather(values_.data());
  among_.gather(values_.data());
  return true;
}

bool LineCgSolver::Family::factor(const double* values, double least_pivot) {
  for (std::size_t k = 0; k < row.size(); ++k) {
    const double a = values[diagonal_at[k]];
    double pivot = a;
    link[k] = 0;
    if (link_at[k] >= 0) {
      link[k] = values[link_at[k]];
      pivot -= link[k] * link[k] * inverse_pivot[previous[k]];
    }
    if (!(pivot > least_pivot * a)) return false;  // the negation catches NaN
    inverse_pivot[k] = 1 / pivot;
  }
  return true;
}

// A row that follows its predecessor takes it from a register: the chain of operations
// along a line, not their number, is what bounds this.
double LineCgSolver::Family::solve(const double* b, double* x) const {
  const int n = size();
  const double *d = inverse_pivot.data(), *e = link.data();
  const int* before = previous.data();
  double last = 0;
  for (int k = 0; k < n; ++k) {
    const int i = before[k];  // k itself at a line's first row, where e = 0
    const double above = i == k - 1 ? last : i == k ? 0 : d[i] * x[i];
    x[k] = b[k] - e[k] * above;
    last = d[k] * x[k];
  }
  double carried = 0;  // what row k + 1 subtracts from row k
  double sum = 0;
  for (int k = n - 1; k >= 0; --k) {
    const double xk = x[k] = (x[k] - carried) * d[k];
    sum += b[k] * xk;
    carried = 0;
    if (before[k] == k - 1) {
      carried = e[k] * xk;
    } else {
      x[before[k]] -= e[k] * xk;
    }
  }
  return sum;
}

void LineCgSolver::solve_lines(double* x) {
  for (const auto& [family, vector] : {std::pair(&eliminated_, &beyond_), {&kept_, &product_}}) {
    for (int k = 0; k < family->size(); ++k) (*vector)[k] = x[family->row[k]];
    family->solve(vector->data(), vector->data());
    for (int k = 0; k < family->size(); ++k) x[family->row[k]] = (*vector)[k];
  }
}

void LineCgSolver::Couplings::gather(const double* values) {
  for (std::size_t i = 0; i < at.size(); ++i) value[i] = values[at[i]];
}

double LineCgSolver::reciprocal_condition() const {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (const Family* family : {&eliminated_, &kept_}) {
    for (const double d : family->inverse_pivot) {
      low = std::min(low, d);
      high = std::max(high, d);
    }
  }
  return low / high;
}

// ---- Conjugate gradients ------------------------------------------------------------------------

// q += (R - C T_A^-1 C^T) p; returns p.q.
double LineCgSolver::multiply(const double* p, double* q) {
  double* y = beyond_.data();
  std::fill(beyond_.begin(), beyond_.end(), 0.0);
  const int n = kept_.size();
  for (int k = 0; k < n; ++k) {
    for (int i = across_.start[k]; i < across_.start[k + 1]; ++i)
      y[across_.column[i]] += across_.value[i] * p[k];
  }
  eliminated_.solve(y, y);
  for (int k = 0; k < n; ++k) {
    for (int i = among_.start[k]; i < among_.start[k + 1]; ++i) {
      q[k] += among_.value[i] * p[among_.column[i]];
      q[among_.column[i]] += among_.value[i] * p[k];
    }
  }
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    double qk = q[k];
    for (int i = across_.start[k]; i < across_.start[k + 1]; ++i)
      qk -= across_.value[i] * y[across_.column[i]];
    q[k] = qk;
    sum += p[k] * qk;
  }
  return sum;
}

bool LineCgSolver::solve_within(double tolerance, double* rhs) {
  const int n = kept_.size();
  double *x = solution_.data(), *r = residual_.data(), *p = direction_.data();
  double *tp = line_direction_.data(), *q = product_.data();
  double norm = 0;
  for (int row = 0; row < pattern_.n; ++row) norm += rhs[row] * rhs[row];
  const double enough = tolerance * tolerance * norm;

  // r = b_B - C T_A^-1 b_A
  for (int k = 0; k < eliminated_.size(); ++k) beyond_[k] = rhs[eliminated_.row[k]];
  eliminated_.solve(beyond_.data(), beyond_.data());
  double error = 0;
  for (int k = 0; k < n; ++k) {
    r[k] = rhs[kept_.row[k]];
    for (int i = across_.start[k]; i < across_.start[k + 1]; ++i)
      r[k] -= across_.value[i] * beyond_[across_.column[i]];
    error += r[k] * r[k];
    x[k] = p[k] = tp[k] = 0;
  }

  double old_energy = 1;
  bool reached = error <= enough;
  for (int i = 0; i < most_iterations_ && !reached; ++i, ++iterations_) {
    const double energy = kept_.solve(r, q);  // z = T_B^-1 r
    const double beta = i == 0 ? 0 : energy / old_energy;
    for (int k = 0; k < n; ++k) {
      p[k] = q[k] + beta * p[k];
      q[k] = tp[k] = r[k] + beta * tp[k];  // T_B p, without a product
    }
    const double curvature = multiply(p, q);
    if (!(energy > 0 && curvature > 0)) break;  // the negation catches NaN
    const double alpha = energy / curvature;
    old_energy = energy;
    error = 0;
    for (int k = 0; k < n; ++k) {
      x[k] += alpha * p[k];
      r[k] -= alpha * q[k];
      error += r[k] * r[k];
    }
    reached = error <= enough;
  }

  // x_A = T_A^-1 (b_A - C^T x_B)
  for (int k = 0; k < eliminated_.size(); ++k) beyond_[k] = rhs[eliminated_.row[k]];
  for (int k = 0; k < n; ++k) {
    for (int i = across_.start[k]; i < across_.start[k + 1]; ++i)
      beyond_[across_.column[i]] -= across_.value[i] * x[k];
    rhs[kept_.row[k]] = x[k];
  }
  eliminated_.solve(beyond_.data(), beyond_.data());
  for (int k = 0; k < eliminated_.size(); ++k) rhs[eliminated_.row[k]] = beyond_[k];
  return reached;
}

}  // namespace inextensible
