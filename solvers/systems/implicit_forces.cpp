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

bool ImplicitForces::factor(double scale) {
  if (scale == factored_) return true;
  double* values = solver_->values();
  for (const Entry& e : entries_) *values++ = e.mass + scale * e.drag + scale * scale * e.stiffness;
  factored_ = solver_->factor() ? scale : 0;
  return factored_ != 0;
}

bool ImplicitForces::advance(double scale, const Positions& w, Positions& y, WorkCounters& work) {
  if (free_vertex_.empty()) return true;
  if (!factor(scale)) return false;
  force_.setZero();
  add_forces(problem_, y, w, force_, work);
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t f = 0; f < free_vertex_.size(); ++f)
      row_[static_cast<Eigen::Index>(f)] = scale * scale * force_(axis, free_vertex_[f]);
    solver_->solve(row_.data());
    ++work.force_solves;
    for (std::size_t f = 0; f < free_vertex_.size(); ++f)
      y(axis, free_vertex_[f]) += row_[static_cast<Eigen::Index>(f)];
  }
  return row_.allFinite();
}

}  // namespace inextensible
