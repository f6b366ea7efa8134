// The saddle-point matrix on chains, by block elimination along each chain.
//
// A block is a vertex and the multiplier of the edge to the next one, (x_i, lambda_i): K is block
// tridiagonal with blocks of 4 x 4, and what a block takes from the next one is 3 x 3. Loops: one
// over blocks to factor, two to solve.
//
// With A the 3 x 3 block of M + H at a vertex less what it has lost to blocks before, g the
// gradient of the edge's C there and k its curvature in H, a block and its coupling to the next
// vertex are
//   P = [ A    g ]      [ -k I ]
//       [ g^T  0 ]  and [ -g^T ].
// P (y, z) = (r, c) has the solution
//   y = s c + S (r - A s c),  z = s^T (r - A y),  s = g / |g|^2,
// where S is the inverse of A across g. P is regular where that exists, whatever A is along the
// edge, so nothing needs to be permuted; and K has the right inertia, M + H positive definite on
// the null space of J, if and only if A across g is positive definite in every block.
#include <stdexcept>

#include "solvers/systems/kkt_system.h"

namespace inextensible {
namespace {

constexpr int chain_refinement_limit = 4;
constexpr double numbers_per_block = 16;      // g, s, a, S and the curvature
constexpr double operations_per_block = 245;  // counted in the text below

// The edge from each vertex to the next one, -1 where there is none; empty if there are others.
std::vector<int> edges_after(const Problem& problem) {
  std::vector<int> after(problem.vertices(), -1);
  for (int k = 0; k < problem.constraints(); ++k) {
    const auto [a, b] = problem.edges()[k];
    int& edge = after[std::min(a, b)];
    if (std::abs(a - b) != 1 || edge >= 0) return {};
    edge = k;
  }
  return after;
}

// Free vertices begin ... end - 1, joined one to the next, and whether pins are joined to the ends.
struct Run {
  int begin, end;
  bool pin_before, pin_after;
};
std::vector<Run> runs_of(const Problem& problem, const std::vector<int>& after) {
  std::vector<Run> runs;
  bool goes_on = false;
  for (int v = 0; v < static_cast<int>(after.size()); ++v) {
    const bool free = problem.inverse_mass()[v] > 0;
    if (free && !goes_on) runs.push_back({v, v, v > 0 && after[v - 1] >= 0, false});
    if (free) runs.back().end = v + 1, runs.back().pin_after = after[v] >= 0;
    goes_on = free && after[v] >= 0;
  }
  return runs;
}

// ---- One block, spelled out as numbers, as in tridiagonal.cpp ----

// Smallest determinant of A across g, over its norm squared.
constexpr double least_determinant = 1e-14;

struct Vector {
  double x = 0, y = 0, z = 0;
};
inline Vector load(const double* p) { return {p[0], p[1], p[2]}; }
inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(double f, Vector a) { return {f * a.x, f * a.y, f * a.z}; }
inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Symmetric {
  double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;
};
inline Vector operator*(const Symmetric& a, Vector v) {
  return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
          a.xz * v.x + a.yz * v.y + a.zz * v.z};
}
// a += factor (v w^T + w v^T) / 2
inline void add_product(Symmetric& a, double factor, Vector v, Vector w) {
  a.xx += factor * v.x * w.x;
  a.yy += factor * v.y * w.y;
  a.zz += factor * v.z * w.z;
  a.xy += 0.5 * factor * (v.x * w.y + v.y * w.x);
  a.xz += 0.5 * factor * (v.x * w.z + v.z * w.x);
  a.yz += 0.5 * factor * (v.y * w.z + v.z * w.y);
}
inline void add_diagonal(Symmetric& a, double number) {
  a.xx += number, a.yy += number, a.zz += number;
}
inline void add_scaled(Symmetric& a, double factor, const Symmetric& b) {
  a.xx += factor * b.xx, a.xy += factor * b.xy, a.yy += factor * b.yy;
  a.xz += factor * b.xz, a.yz += factor * b.yz, a.zz += factor * b.zz;
}

struct ChainBlock {
  Vector g, s, a;     // a = A s
  Symmetric inverse;  // S; at the end of a chain that of A
  double curvature = 0;
  int negative = 0;  // pivots

  // The block of an edge; false: it is not regular.
  bool pivot(const Symmetric& matrix) {
    const double squared = dot(g, g);
    s = (1 / squared) * g;
    a = matrix * s;
    const Vector n = (1 / std::sqrt(squared)) * g;
    const Vector an = std::sqrt(squared) * a;
    const double along = dot(n, an);
    Symmetric across = matrix;  // (I - n n^T) A (I - n n^T)
    add_product(across, -2, n, an);
    add_product(across, along, n, n);
    const double trace = across.xx + across.yy + across.zz;
    const double norm = across.xx * across.xx + across.yy * across.yy + across.zz * across.zz +
                        2 * (across.xy * across.xy + across.xz * across.xz + across.yz * across.yz);
    const double determinant = 0.5 * (trace * trace - norm);
    // S = (trace (I - n n^T) - across) / determinant, as for any 2 x 2 matrix
    inverse = {};
    add_diagonal(inverse, trace / determinant);
    add_product(inverse, -trace / determinant, n, n);
    add_scaled(inverse, -1 / determinant, across);
    negative = 1 + (determinant < 0 ? 1 : trace < 0 ? 2 : 0);                // 1: the multiplier's
    return squared > 0 && std::abs(determinant) > least_determinant * norm;  // false on NaN
  }

  // The block of the last vertex of a chain without pins.
  bool pivot_last(const Symmetric& m) {
    const double cxx = m.yy * m.zz - m.yz * m.yz, cxy = m.xz * m.yz - m.xy * m.zz,
                 cxz = m.xy * m.yz - m.xz * m.yy;
    const double determinant = m.xx * cxx + m.xy * cxy + m.xz * cxz;
    const double leading = m.xx * m.yy - m.xy * m.xy;
    inverse = {cxx, cxy, m.xx * m.zz - m.xz * m.xz, cxz, m.xy * m.xz - m.xx * m.yz, leading};
    const double f = 1 / determinant;
    inverse = {f * inverse.xx, f * inverse.xy, f * inverse.yy,
               f * inverse.xz, f * inverse.yz, f * inverse.zz};
    g = s = a = {};
    // Jacobi's rule: as often as the leading minors change their sign.
    negative =
        (m.xx < 0 ? 1 : 0) + (m.xx * leading < 0 ? 1 : 0) + (leading * determinant < 0 ? 1 : 0);
    const double largest = std::abs(m.xx) + std::abs(m.yy) + std::abs(m.zz),
                 smallest = std::abs(determinant) / (largest * largest);
    return m.xx != 0 && leading != 0 && smallest > least_determinant * largest;
  }

  // What is left of the next block's A.
  void take_from(Symmetric& next) const {
    const Vector b = inverse * a;
    add_scaled(next, -curvature * curvature, inverse);
    add_product(next, 2 * curvature, b - s, g);
    add_product(next, dot(a, s) - dot(a, b), g, g);
  }

  struct Solution {
    Vector y;
    double z;
  };
  Solution solve(Vector r, double c) const {
    const Vector y = c * s + inverse * (r - c * a);
    return {y, dot(s, r) - dot(a, y)};
  }
};

// ---- All of them ----

class ChainKkt final : public KktSolver {
 public:
  ChainKkt(const Problem& problem, const EdgeConstraints& edges)
      : KktSolver(problem, edges),
        curvature_(problem.constraints()),
        r_(3, problem.vertices()),
        correction_p_(3, problem.vertices()),
        c_(problem.constraints()),
        correction_q_(problem.constraints()) {
    if (!forms_chains(problem))
      throw std::invalid_argument(
          "the linear solver 'block_tridiagonal' needs vertices that form chains in order, each "
          "pinned once at most between its ends");
    // By place in `edges`, which may have an order of its own.
    std::vector<int> place(edges.count());
    for (int k = 0; k < edges.count(); ++k) place[edges.problem_edge(k)] = k;
    std::vector<int> after = edges_after(problem);
    const std::vector<Run> runs = runs_of(problem, after);
    for (int& edge : after) edge = edge < 0 ? -1 : place[edge];
    for (const auto& [begin, end, down, unused] : runs) {  // towards the pin
      for (int i = 0; i < end - begin; ++i) {
        const int vertex = down ? end - 1 - i : begin + i, edge = after[down ? vertex - 1 : vertex];
        links_.push_back({vertex, edge, edge >= 0 && edges_.a[edge] == vertex, i + 1 < end - begin,
                          problem.mass()[vertex] / mean_mass_});
      }
    }
    blocks_.resize(links_.size());
  }

 private:
  // A free vertex, in elimination order: towards the pin where there is one.
  struct Link {
    int vertex;
    int edge;        // to the next vertex; -1 at the end of a chain
    bool turned;     // the vertex is the edge's a
    bool next_free;  // the next vertex is the next link's
    double mass;     // over the mean mass
  };

  bool eliminate() {
    negative_pivots_ = 0;
    Symmetric here;  // A_i but for its mass and the edge to the next vertex
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Link& link = links_[i];
      ChainBlock& block = blocks_[i];
      add_diagonal(here, link.mass);
      bool regular = true;
      if (link.edge < 0) {
        regular = block.pivot_last(here);
      } else {
        block.curvature = curvature_[link.edge];
        block.g = (link.turned ? -1.0 : 1.0) * load(u_->data() + 3 * link.edge);
        add_diagonal(here, block.curvature);
        regular = block.pivot(here);
      }
      if (!regular) return false;
      negative_pivots_ += block.negative;
      here = {};
      if (!link.next_free) continue;
      add_diagonal(here, block.curvature);
      block.take_from(here);
    }
    return true;
  }

  bool factor_itself(WorkCounters& work) override {
    for (;; convex_ = true) {
      convexified_ = convex_;
      for (Eigen::Index k = 0; k < mu_->size(); ++k) curvature_[k] = curvature(k);
      ++work.assemblies;
      ++work.factorizations;
      if (!eliminate()) return false;
      work.factor_nonzeros = numbers_per_block * static_cast<double>(links_.size());
      work.factor_flops = operations_per_block * static_cast<double>(links_.size());
      if (convex_ || negative_pivots_ == edges_.count()) return true;
    }
  }

  std::unique_ptr<KktSolver> make_other() const override {
    return make_kkt_system(problem_, edges_, FactoredBy::umfpack);
  }

  void substitute(Positions& p, Eigen::VectorXd& q) const {
    const auto right = [&](const Link& link) { return link.edge < 0 ? 0.0 : q[link.edge]; };
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Link& link = links_[i];
      if (!link.next_free) continue;
      const ChainBlock& block = blocks_[i];
      const auto [y, z] = block.solve(load(p.data() + 3 * link.vertex), right(link));
      const Vector taken = block.curvature * y + z * block.g;
      double* next = p.data() + 3 * links_[i + 1].vertex;
      next[0] += taken.x, next[1] += taken.y, next[2] += taken.z;
    }
    Vector next;
    for (std::size_t i = links_.size(); i-- > 0;) {
      const Link& link = links_[i];
      const ChainBlock& block = blocks_[i];
      if (!link.next_free) next = {};
      double* at = p.data() + 3 * link.vertex;
      const auto [y, z] =
          block.solve(load(at) + block.curvature * next, right(link) + dot(block.g, next));
      at[0] = y.x, at[1] = y.y, at[2] = y.z;
      if (link.edge >= 0) q[link.edge] = z;
      next = y;
    }
  }

  // r_ and c_ less K (p, q); returns the norm of what is left.
  double subtract_product(const Positions& p, const Eigen::VectorXd& q) {
    double sum = 0;
    Vector from_before;  // what the edge before has taken from r_ at its far end
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Link& link = links_[i];
      const ChainBlock& block = blocks_[i];
      double* r = r_.data() + 3 * link.vertex;
      const Vector here = load(p.data() + 3 * link.vertex);
      const Vector next = link.next_free ? load(p.data() + 3 * links_[i + 1].vertex) : Vector{};
      Vector force = block.curvature * (here - next);
      if (link.edge >= 0) {
        force = force + q[link.edge] * block.g;
        double& c = c_[link.edge];
        c -= dot(block.g, here - next);
        sum += c * c;
      }
      const Vector left = load(r) - link.mass * here - force + from_before;
      r[0] = left.x, r[1] = left.y, r[2] = left.z;
      sum += dot(left, left);
      from_before = link.next_free ? force : Vector{};
    }
    return std::sqrt(sum);
  }

  bool solve_itself(const Positions& r, const Eigen::VectorXd& c, Positions& p, Eigen::VectorXd& q,
                    WorkCounters& work) override {
    const auto begin_again = [&] {
      r_ = r;
      for (const int vertex : problem_.pinned()) r_.col(vertex).setZero();
      c_ = c;
    };
    begin_again();
    const double scale = std::sqrt(r_.squaredNorm() + c_.squaredNorm());
    p.setZero();
    q.setZero();
    double error = scale;
    for (int i = 0; i < chain_refinement_limit && error > refinement_goal * scale; ++i) {
      correction_p_ = r_;
      correction_q_ = c_;
      substitute(correction_p_, correction_q_);
      ++work.back_solves;
      p += correction_p_;
      q += correction_q_;
      const double last = error;
      begin_again();
      error = subtract_product(p, q);
      if (!(error < 0.5 * last)) break;
    }
    return error <= acceptable_residual * scale;  // false on NaN
  }

  std::vector<Link> links_;
  std::vector<ChainBlock> blocks_;  // the factor, one a link
  int negative_pivots_ = 0;
  Eigen::VectorXd curvature_;  // of each edge in H
  Positions r_, correction_p_;
  Eigen::VectorXd c_, correction_q_;
};

}  // namespace

bool forms_chains(const Problem& problem) {
  const std::vector<int> after = edges_after(problem);
  const std::vector<Run> runs = runs_of(problem, after);
  return !after.empty() &&
         std::ranges::none_of(runs, [](const Run& run) { return run.pin_before && run.pin_after; });
}

std::unique_ptr<KktSolver> make_chain_kkt(const Problem& problem, const EdgeConstraints& edges) {
  return std::make_unique<ChainKkt>(problem, edges);
}

}  // namespace inextensible
