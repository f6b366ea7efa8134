#include "solvers/systems/implicit_forces.h"

#include <algorithm>
#include <map>

#include "solvers/linear/spd_solvers.h"
#include "solvers/problem/forces.h"
#include "solvers/systems/vertex_blocks.h"

namespace inextensible {
namespace {

// The stiffness between two vertices, or of one with itself.
using Stiffnesses = std::map<std::pair<int, int>, double>;

Stiffnesses stiffness_matrix(const Problem& problem) {
  Stiffnesses all;
  const auto add = [&all](int a, int b, double k) { all[std::minmax(a, b)] += k; };
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
  return all;
}

}  // namespace

ImplicitForces::ImplicitForces(const Problem& problem) : problem_(problem) {
  const Stiffnesses stiffness = stiffness_matrix(problem);
  std::vector<int> place(problem.vertices(), -1);
  for (int v = 0; v < problem.vertices(); ++v) {
    if (problem.inverse_mass()[v] == 0) continue;
    place[v] = static_cast<int>(free_vertex_.size());
    free_vertex_.push_back(v);
  }
  const int n = static_cast<int>(free_vertex_.size());
  const auto graph = [&] {
    std::vector<Edge> pairs;
    for (const auto& [pair, k] : stiffness) {
      const Edge free{place[pair.first], place[pair.second]};
      if (free.a >= 0 && free.b >= 0 && free.a != free.b) pairs.push_back(free);
    }
    return vertex_graph(n, pairs);
  };
  std::vector<int> ordered(free_vertex_.size());
  const std::vector<int> order = fill_reducing_order(graph());
  for (std::size_t f = 0; f < ordered.size(); ++f) ordered[f] = free_vertex_[order[f]];
  free_vertex_ = std::move(ordered);
  for (int f = 0; f < n; ++f) place[free_vertex_[f]] = f;

  SymmetricPattern pattern = lower_triangle(graph());
  for (int column = 0; column < n; ++column) {
    for (int i = pattern.column_start[column]; i < pattern.column_start[column + 1]; ++i) {
      const int a = free_vertex_[pattern.row_index[i]], b = free_vertex_[column];
      const auto found = stiffness.find(std::minmax(a, b));
      Entry entry{i, found == stiffness.end() ? 0 : found->second};
      if (a == b) {
        entry.mass = problem.mass()[a];
        entry.drag = problem.drag(a);
      }
      entries_.push_back(entry);
    }
  }
  solver_ = make_spd_solver("multifrontal", std::move(pattern));
  force_.resize(3, problem.vertices());
  row_.resize(n);
}

bool ImplicitForces::factor(double scale) {
  if (scale == factored_) return true;
  double* values = solver_->values();
  for (const Entry& e : entries_)
    values[e.place] = e.mass + scale * e.drag + scale * scale * e.stiffness;
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
