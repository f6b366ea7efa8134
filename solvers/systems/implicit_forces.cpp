#include "solvers/systems/implicit_forces.h"

#include <cmath>

#include "solvers/problem/forces.h"
#include "solvers/systems/vertex_matrix.h"

namespace inextensible {
namespace {

// Calls add(a, b, k) for each stiffness k of shear between two vertices, or of one with itself.
template <class Add>
void for_each_shear(const Problem& problem, Add add) {
  if (const Springs* shear = problem.shear())
    for (std::size_t s = 0; s < shear->edges.size(); ++s) {
      const auto [a, b] = shear->edges[s];
      const double k = shear->stiffness[s];
      add(a, a, k);
      add(b, b, k);
      add(a, b, -k);
    }
}

// The same of bending.
template <class Add>
void for_each_bending(const Problem& problem, Add add) {
  for (const BendingStencil& s : problem.bending())
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        const double k = s.stiffness * s.coefficient[i] * s.coefficient[j];
        if (k == 0) continue;
        // A pair stands for both of its places, the diagonal for one.
        add(s.vertex[i], s.vertex[j], i != j && s.vertex[i] == s.vertex[j] ? 2 * k : k);
      }
}

Pairs stiff_pairs(const Problem& problem) {
  Pairs pairs;
  const auto add = [&](int a, int b, double) { pairs.emplace_back(a, b); };
  for_each_shear(problem, add);
  for_each_bending(problem, add);
  return pairs;
}

// h times the largest angular frequency, to which steps with explicit forces are taken. One-step
// rules are stable to 2, BDF2 to 1.78; the bounds on frequencies are not always reached.
constexpr double explicit_phase = 1.75;

// s: with h^2 L at most explicit_phase^2 M in a row, L by Gershgorin's circle.
double longest_explicit_step(double stiffness, double mass) {
  return explicit_phase * std::sqrt(mass / stiffness);
}

}  // namespace

ImplicitForces::ImplicitForces(const Problem& problem) : problem_(problem) {
  VertexMatrix matrix(problem, stiff_pairs(problem), "multifrontal_mixed", 1);
  entries_.resize(matrix.pattern.entries());
  const auto adds_to = [&](double Entry::*part) {
    return [&, part](int a, int b, double k) {
      const int f = matrix.place[a], g = matrix.place[b];
      if (f >= 0 && g >= 0) entries_[matrix.pattern.place(f, g)].*part += k;
    };
  };
  for_each_shear(problem, adds_to(&Entry::shear));
  for_each_bending(problem, adds_to(&Entry::bending));
  free_vertex_ = std::move(matrix.vertex);
  solver_ = std::move(matrix.solver);
  for (std::size_t f = 0; f < free_vertex_.size(); ++f) {
    Entry& entry = entries_[matrix.pattern.diagonal(static_cast<int>(f))];
    entry.mass = problem.mass()[free_vertex_[f]];
    entry.drag = problem.drag(free_vertex_[f]);
  }
  Eigen::Matrix2Xd circles = Eigen::Matrix2Xd::Zero(2, matrix.pattern.n);  // all; shear alone
  for (int column = 0; column < matrix.pattern.n; ++column) {
    for (int e = matrix.pattern.column_start[column]; e < matrix.pattern.column_start[column + 1];
         ++e) {
      const int row = matrix.pattern.row_index[e];
      const Entry& entry = entries_[e];
      const Eigen::Vector2d sizes(std::abs(entry.shear + entry.bending), std::abs(entry.shear));
      circles.col(column) += sizes;
      if (row != column) circles.col(row) += sizes;
    }
  }
  explicit_step_ = shear_step_ = std::numeric_limits<double>::infinity();
  for (int f = 0; f < matrix.pattern.n; ++f) {
    const Entry& entry = entries_[matrix.pattern.diagonal(f)];
    explicit_step_ = std::min(explicit_step_, longest_explicit_step(circles(0, f), entry.mass));
    shear_step_ = std::min(shear_step_, longest_explicit_step(circles(1, f), entry.mass));
  }
  force_.resize(3, problem.vertices());
  motion_.setZero(4, static_cast<Eigen::Index>(free_vertex_.size()));
}

ImplicitForces::Late ImplicitForces::late(double h) const {
  if (h > shear_step_) return Late::bending_and_shear;
  return h > explicit_step_ ? Late::bending : Late::nothing;
}

void ImplicitForces::find_forces(const State& start, double ahead, Late late, const Positions& end,
                                 const Positions& w, WorkCounters& work) {
  if (late != Late::bending_and_shear) early_ = start.x + ahead * start.v;
  force_.setZero();
  add_forces(problem_, late == Late::nothing ? early_ : end,
             late == Late::bending_and_shear ? end : early_, w, force_, work);
}

bool ImplicitForces::factor(double scale, double drag, Late late) {
  if (scale == factored_ && drag == factored_drag_ && late == factored_late_) return true;
  double* values = solver_->values();
  const double of_shear = late == Late::bending_and_shear ? scale * scale : 0;
  for (const Entry& e : entries_)
    *values++ = e.mass + drag * e.drag + scale * scale * e.bending + of_shear * e.shear;
  factored_ = solver_->factor() ? scale : 0;
  factored_drag_ = drag;
  factored_late_ = late;
  return factored_ != 0;
}

bool ImplicitForces::advance(const State& start, double h, double scale, double ahead,
                             const Positions& w, Positions& y, WorkCounters& work) {
  find_forces(start, ahead, late(h), y, w, work);
  return add_solution(scale, scale, late(h), 1, y, work);
}

// About y it is (M + h / 2 D + s^2 L) theta (x0 - y) = s^2 (-grad V(y_theta) - D (y - x^n) / h),
// with s = theta h.
bool ImplicitForces::advance_inside(const State& start, double h, double theta, Positions& y,
                                    Positions& x0, WorkCounters& work) {
  free_flight(problem_, start, h, 0.5 * h * h, y);
  x0 = y;
  inside_ = (1 - theta) * start.x + theta * y;
  velocity_ = (y - start.x) * (1 / h);
  find_forces(start, 0.5 * h, late(h), inside_, velocity_, work);
  for (const int vertex : free_vertex_)
    force_.col(vertex) -= problem_.mass()[vertex] * problem_.gravity();
  return add_solution(theta * h, 0.5 * h, late(h), 1 / theta, x0, work);
}

bool ImplicitForces::add_solution(double scale, double drag, Late late, double factor, Positions& y,
                                  WorkCounters& work) {
  if (late == Late::nothing) {
    for (const int vertex : free_vertex_) {
      const double diagonal = problem_.mass()[vertex] + drag * problem_.drag(vertex);
      y.col(vertex) += (factor * scale * scale / diagonal) * force_.col(vertex);
    }
    return y.allFinite();
  }
  if (free_vertex_.empty()) return true;
  if (!this->factor(scale, drag, late)) return false;
  Eigen::Index f = 0;
  for (const int vertex : free_vertex_)
    motion_.col(f++).head<3>() = scale * scale * force_.col(vertex);
  solver_->solve_coordinates(motion_);
  work.force_solves += 3;
  f = 0;
  for (const int vertex : free_vertex_) y.col(vertex) += factor * motion_.col(f++).head<3>();
  return motion_.allFinite();
}

bool unconstrained_step(const Problem& problem, ImplicitForces* implicit, const State& state,
                        double h, Positions& x0, WorkCounters& work) {
  if (!implicit) {
    unconstrained_step(problem, state, h, x0, work);
    return true;
  }
  x0 = state.x + h * state.v;
  for (const int vertex : problem.pinned()) x0.col(vertex) = state.x.col(vertex);
  return implicit->advance(state, h, h, 0, state.v, x0, work);
}

}  // namespace inextensible
