#include "solvers/problem/forces.h"

#include <cmath>

namespace inextensible {
namespace {

// y -= scale W grad V of each stencil.
void add_bending_acceleration(const Bending& bending, const std::vector<double>& w,
                              const Positions& x, double scale, Positions& y) {
  const double* p = x.data();
  double* q = y.data();
  for (const BendingStencil& s : bending) {
    double sum[3] = {0, 0, 0};
    for (std::size_t i = 0; i < 4; ++i) {
      const double* at = p + 3 * s.vertex[i];
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += s.coefficient[i] * at[axis];
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const double f = scale * s.stiffness * s.coefficient[i] * w[s.vertex[i]];
      double* at = q + 3 * s.vertex[i];
      for (std::size_t axis = 0; axis < 3; ++axis) at[axis] -= f * sum[axis];
    }
  }
}

// y += scale W f of each spring: f pulls b towards a with stiffness (|d| - r).
void add_spring_acceleration(const Springs& springs, const std::vector<double>& w,
                             const Positions& x, double scale, Positions& y) {
  const double* p = x.data();
  double* q = y.data();
  for (std::size_t k = 0; k < springs.edges.size(); ++k) {
    const auto [a, b] = springs.edges[k];
    const double* pa = p + 3 * a;
    const double* pb = p + 3 * b;
    const double d0 = pb[0] - pa[0], d1 = pb[1] - pa[1], d2 = pb[2] - pa[2];
    const double length = std::sqrt(d0 * d0 + d1 * d1 + d2 * d2);
    // A spring of length zero has no direction; its force is taken as zero.
    const double f =
        length > 0 ? scale * springs.stiffness[k] * (1 - springs.rest_length[k] / length) : 0;
    const double fa = f * w[a], fb = f * w[b];
    double* qa = q + 3 * a;
    double* qb = q + 3 * b;
    qa[0] += fa * d0;
    qa[1] += fa * d1;
    qa[2] += fa * d2;
    qb[0] -= fb * d0;
    qb[1] -= fb * d1;
    qb[2] -= fb * d2;
  }
}

void add_accelerations(const Problem& problem, const Positions& x, const Positions& shear_at,
                       double scale, Positions& y, WorkCounters& work) {
  const Eigen::Vector3d fall = scale * problem.gravity();
  y.colwise() += fall;
  if (const Springs* shear = problem.shear()) {
    add_spring_acceleration(*shear, problem.inverse_mass(), shear_at, scale, y);
    work.spring_evaluations += static_cast<std::int64_t>(shear->edges.size());
  }
  if (!problem.bending().empty()) {
    add_bending_acceleration(problem.bending(), problem.inverse_mass(), x, scale, y);
    work.spring_evaluations += static_cast<std::int64_t>(problem.bending().size());
  }
}

}  // namespace

void add_acceleration(const Problem& problem, const Positions& x, double scale, Positions& y,
                      WorkCounters& work) {
  add_accelerations(problem, x, x, scale, y, work);
}

void add_drag(const Problem& problem, const Positions& v, double scale, Positions& y) {
  for (int i = 0; i < problem.vertices(); ++i)
    y.col(i) -= scale * problem.inverse_mass()[i] * problem.drag(i) * v.col(i);
}

void add_forces(const Problem& problem, const Positions& x, const Positions& shear_at,
                const Positions& v, Positions& f, WorkCounters& work) {
  // As accelerations times masses: of stiff forces the rounding is that of two multiplications.
  add_accelerations(problem, x, shear_at, 1, f, work);
  if (problem.has_drag()) add_drag(problem, v, 1, f);
  for (int i = 0; i < problem.vertices(); ++i) f.col(i) *= problem.mass()[i];
}

void unconstrained_step(const Problem& problem, const State& state, double h, Positions& x0,
                        WorkCounters& work) {
  x0 = state.x + h * state.v;
  add_acceleration(problem, state.x, h * h, x0, work);
  if (problem.has_drag()) add_drag(problem, state.v, h * h, x0);
  for (const int vertex : problem.pinned()) x0.col(vertex) = state.x.col(vertex);
}

double spring_energy(const Springs& springs, const Positions& x) {
  double energy = 0;
  for (std::size_t k = 0; k < springs.edges.size(); ++k) {
    const auto [a, b] = springs.edges[k];
    const double elongation = (x.col(b) - x.col(a)).norm() - springs.rest_length[k];
    energy += 0.5 * springs.stiffness[k] * elongation * elongation;
  }
  return energy;
}

double potential_energy(const Problem& problem, const Positions& x) {
  // Term by term: Eigen's own sums go by the address of what they add up, so that equal runs would
  // differ by a rounding.
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < x.cols(); ++i) moment += problem.mass()[i] * x.col(i);
  double energy = -problem.gravity().dot(moment);
  if (const Springs* shear = problem.shear()) energy += spring_energy(*shear, x);
  return energy + bending_energy(problem.bending(), x);
}

double kinetic_energy(const Problem& problem, const Positions& v) {
  double sum = 0;
  for (Eigen::Index i = 0; i < v.cols(); ++i) sum += problem.mass()[i] * v.col(i).squaredNorm();
  return 0.5 * sum;
}

}  // namespace inextensible
