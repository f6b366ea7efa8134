#include "solvers/systems/implicit_forces.h"

#include "solvers/linear/spd_solvers.h"
#include "solvers/problem/forces.h"

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

}  // namespace

ImplicitForces::ImplicitForces(const Problem& problem) : problem_(problem) {
  for (int v = 0; v < problem.vertices(); ++v) {
    if (problem.inverse_mass()[v] > 0) free_vertex_.push_back(v);
  }
  const int n = static_cast<int>(free_vertex_.size());
  std::vector<int> place(problem.vertices(), -1);
  const auto for_each_entry = [&](auto add) {  // of the free vertices
    for_each_stiffness(problem, [&](int a, int b, double k) {
      if (place[a] >= 0 && place[b] >= 0) add(place[a], place[b], k);
    });
  };
  const auto pattern_in = [&](const std::vector<int>& order, SymmetricPattern::Triangle triangle) {
    for (int f = 0; f < n; ++f) place[order[f]] = f;
    Pairs pairs;
    for_each_entry([&](int f, int g, double) { pairs.emplace_back(f, g); });
    return pattern_of(n, pairs, triangle);
  };
  std::vector<int> ordered = free_vertex_;
  const std::vector<int> order =
      fill_reducing_order(pattern_in(free_vertex_, SymmetricPattern::Triangle::upper));
  for (int f = 0; f < n; ++f) ordered[f] = free_vertex_[order[f]];
  free_vertex_ = std::move(ordered);

  SymmetricPattern pattern = pattern_in(free_vertex_, SymmetricPattern::Triangle::lower);
  entries_.resize(pattern.entries());
  for_each_entry([&](int f, int g, double k) { entries_[pattern.place(f, g)].stiffness += k; });
  for (int f = 0; f < n; ++f) {
    Entry& entry = entries_[pattern.diagonal(f)];
    entry.mass = problem.mass()[free_vertex_[f]];
    entry.drag = problem.drag(free_vertex_[f]);
  }
  solver_ = make_spd_solver("multifrontal", std::move(pattern));
  force_.resize(3, problem.vertices());
  row_.resize(n);
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
