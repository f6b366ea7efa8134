#include "solvers/systems/implicit_forces.h"

#include "solvers/problem/forces.h"
#include "solvers/systems/vertex_matrix.h"

namespace inextensible {
namespace {

// Calls add(a, b, k) for each stiffness k between two vertices, or of one with itself.
template <class Add>
void for_each_stiffness(const Problem& problem, Add add) {
  if (const Springs* shear = problem.shear()) {
    for (std::size_t s = 0; s < shear->edges.size(); ++s) {
      const auto [a, b] = shear->edges[s];
      const double k = shear->stiffness[s];
      add(a, a, k);
      add(b, b, k);
      add(a, b, -k);
    }
  }
  for (const BendingStencil& s : problem.bending()) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const double k = s.stiffness * s.coefficient[i] * s.coefficient[j];
        if (k == 0) continue;
        // A pair stands for both of its places, the diagonal for one.
        add(s.vertex[i], s.vertex[j], i != j && s.vertex[i] == s.vertex[j] ? 2 * k : k);
      }
    }
  }
}

Pairs stiff_pairs(const Problem& problem) {
  Pairs pairs;
  for_each_stiffness(problem, [&](int a, int b, double) { pairs.emplace_back(a, b); });
  return pairs;
}

}  // namespace

ImplicitForces::ImplicitForces(const Problem& problem) : problem_(problem) {
  VertexMatrix matrix(problem, stiff_pairs(problem), "multifrontal", 1);
  entries_.resize(matrix.pattern.entries());
  for_each_stiffness(problem, [&](int a, int b, double k) {
    const int f = matrix.place[a], g = matrix.place[b];
    if (f >= 0 && g >= 0) entries_[matrix.pattern.place(f, g)].stiffness += k;
  });
  free_vertex_ = std::move(matrix.vertex);
  solver_ = std::move(matrix.solver);
  for (std::size_t f = 0; f < free_vertex_.size(); ++f) {
    Entry& entry = entries_[matrix.pattern.diagonal(static_cast<int>(f))];
    entry.mass = problem.mass()[free_vertex_[f]];
    entry.drag = problem.drag(free_vertex_[f]);
  }
  force_.resize(3, problem.vertices());
  row_.resize(static_cast<Eigen::Index>(free_vertex_.size()));
}

bool ImplicitForces::factor(double scale, double drag) {
  if (scale == factored_ && drag == factored_drag_) return true;
  double* values = solver_->values();
  for (const Entry& e : entries_) *values++ = e.mass + drag * e.drag + scale * scale * e.stiffness;
  factored_ = solver_->factor() ? scale : 0;
  factored_drag_ = drag;
  return factored_ != 0;
}

bool ImplicitForces::advance(double scale, const Positions& w, Positions& y, WorkCounters& work) {
  force_.setZero();
  add_forces(problem_, y, w, force_, work);
  return add_solution(scale, scale, 1, y, work);
}

// About y it is (M + h / 2 D + s^2 L) theta (x0 - y) = s^2 (-grad V(y_theta) - D (y - x^n) / h),
// with s = theta h.
bool ImplicitForces::advance_inside(double theta, double h, const Positions& x_start, Positions& y,
                                    WorkCounters& work) {
  inside_ = (1 - theta) * x_start + theta * y;
  velocity_ = (y - x_start) * (1 / h);
  force_.setZero();
  add_forces(problem_, inside_, velocity_, force_, work);
  for (const int vertex : free_vertex_)
    force_.col(vertex) -= problem_.mass()[vertex] * problem_.gravity();
  return add_solution(theta * h, 0.5 * h, 1 / theta, y, work);
}

bool ImplicitForces::add_solution(double scale, double drag, double factor, Positions& y,
                                  WorkCounters& work) {
  if (free_vertex_.empty()) return true;
  if (!this->factor(scale, drag)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t f = 0; f < free_vertex_.size(); ++f)
      row_[static_cast<Eigen::Index>(f)] = scale * scale * force_(axis, free_vertex_[f]);
    solver_->solve(row_.data());
    ++work.force_solves;
    for (std::size_t f = 0; f < free_vertex_.size(); ++f)
      y(axis, free_vertex_[f]) += factor * row_[static_cast<Eigen::Index>(f)];
  }
  return row_.allFinite();
}

bool unconstrained_step(const Problem& problem, ImplicitForces* implicit, const State& state,
                        double h, Positions& x0, WorkCounters& work) {
  if (!implicit) {
    unconstrained_step(problem, state, h, x0, work);
    return true;
  }
  x0 = state.x + h * state.v;
  for (const int vertex : problem.pinned()) x0.col(vertex) = state.x.col(vertex);
  return implicit->advance(h, state.v, x0, work);
}

}  // namespace inextensible
