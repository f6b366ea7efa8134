#include "solvers/problem/forces.h"

#include <cmath>

namespace inextensible {
namespace {

// q -= scale W grad V of n stencils, the first of them s, at p.
template <std::size_t n>
void add_bending(const BendingStencil& s, const double* w, const double* p, double scale,
                 double* q) {
  double sum[3 * n] = {}, f[3 * n];
  for (std::size_t role = 0; role < 4; ++role) {
    const double* at = p + 3 * s.vertex[role];
    for (std::size_t i = 0; i < 3 * n; ++i) sum[i] += s.coefficient[role] * at[i];
  }
  for (std::size_t role = 0; role < 4; ++role) {
    const double all = scale * s.stiffness * s.coefficient[role];
    for (std::size_t i = 0; i < n; ++i)
      f[3 * i] = f[3 * i + 1] = f[3 * i + 2] =
          all * w[static_cast<std::size_t>(s.vertex[role]) + i];
    double* at = q + 3 * s.vertex[role];
    for (std::size_t i = 0; i < 3 * n; ++i) at[i] -= f[i] * sum[i];
  }
}

// q += scale W f of n springs, the first of them e, at p: f pulls b towards a with k (|d| - r).
template <std::size_t n>
void add_springs(const Edge& e, const double* k, const double* r, const double* w, const double* p,
                 double scale, double* q) {
  const double *pa = p + 3 * e.a, *pb = p + 3 * e.b;
  double d[3 * n], fa[3 * n], fb[3 * n];
  for (std::size_t i = 0; i < 3 * n; ++i) d[i] = pb[i] - pa[i];
  for (std::size_t i = 0; i < n; ++i) {
    const double d0 = d[3 * i], d1 = d[3 * i + 1], d2 = d[3 * i + 2];
    const double length = std::sqrt(d0 * d0 + d1 * d1 + d2 * d2);
    // A spring of length zero has no direction; its force is taken as zero.
    const double f = length > 0 ? scale * k[i] * (1 - r[i] / length) : 0;
    fa[3 * i] = fa[3 * i + 1] = fa[3 * i + 2] = f * w[static_cast<std::size_t>(e.a) + i];
    fb[3 * i] = fb[3 * i + 1] = fb[3 * i + 2] = f * w[static_cast<std::size_t>(e.b) + i];
  }
  double *qa = q + 3 * e.a, *qb = q + 3 * e.b;
  for (std::size_t i = 0; i < 3 * n; ++i) qa[i] += fa[i] * d[i];
  for (std::size_t i = 0; i < 3 * n; ++i) qb[i] -= fb[i] * d[i];
}

// Calls add.operator()<n>(i) for stencils i ... i + n - 1 of one run (Problem::shear_runs).
template <class Add>
void for_each_group(const std::vector<std::size_t>& runs, Add add) {
  std::size_t i = 0;
  for (const std::size_t run : runs) {
    const std::size_t end = i + run;
    for (; i + 8 <= end; i += 8) add.template operator()<8>(i);
    for (; i + 4 <= end; i += 4) add.template operator()<4>(i);
    for (; i < end; ++i) add.template operator()<1>(i);
  }
}

void add_accelerations(const Problem& problem, const Positions& x, const Positions& shear_at,
                       double scale, Positions& y, WorkCounters& work) {
  const Eigen::Vector3d fall = scale * problem.gravity();
  y.colwise() += fall;
  const double* w = problem.inverse_mass().data();
  if (const Springs* shear = problem.shear()) {
    for_each_group(problem.shear_runs(), [&]<std::size_t n>(std::size_t i) {
      add_springs<n>(shear->edges[i], &shear->stiffness[i], &shear->rest_length[i], w,
                     shear_at.data(), scale, y.data());
    });
    work.spring_evaluations += static_cast<std::int64_t>(shear->edges.size());
  }
  const Bending& bending = problem.bending();
  for_each_group(problem.bending_runs(), [&]<std::size_t n>(std::size_t i) {
    add_bending<n>(bending[i], w, x.data(), scale, y.data());
  });
  work.spring_evaluations += static_cast<std::int64_t>(bending.size());
}

}  // namespace

void free_flight(const Problem& problem, const State& state, double h, double scale, Positions& y) {
  const Eigen::Vector3d fall = scale * problem.gravity();
  y = state.x + h * state.v;
  y.colwise() += fall;
  for (const int vertex : problem.pinned()) y.col(vertex) = state.x.col(vertex);
}

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

double potential_energy(const Problem& problem, const Positions& x) {
  // Term by term: Eigen's sums go by addresses, so that equal runs would differ by a rounding.
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < x.cols(); ++i) moment += problem.mass()[i] * x.col(i);
  const double energy = -problem.gravity().dot(moment);
  double of_shear = 0;
  const Springs* shear = problem.shear();
  for (std::size_t k = 0; shear && k < shear->edges.size(); ++k) {
    const auto [a, b] = shear->edges[k];
    const double elongation = (x.col(b) - x.col(a)).norm() - shear->rest_length[k];
    of_shear += 0.5 * shear->stiffness[k] * elongation * elongation;
  }
  return energy + of_shear + bending_energy(problem.bending(), x);
}

double kinetic_energy(const Problem& problem, const Positions& v) {
  double sum = 0;
  for (Eigen::Index i = 0; i < v.cols(); ++i) sum += problem.mass()[i] * v.col(i).squaredNorm();
  return 0.5 * sum;
}

}  // namespace inextensible
