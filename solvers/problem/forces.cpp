#include "solvers/problem/forces.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace inextensible {
namespace {

using Four = double __attribute__((vector_size(32)));
// n numbers that follow each other.
template <int n>
using Numbers = std::conditional_t<n == 4, Four, double>;
template <int n>
Numbers<n> numbers(const double* from) {
  Numbers<n> all;
  std::memcpy(&all, from, sizeof all);
  return all;
}

// x, y and z of n vertices that follow each other, n = 1 or 4; of four in three vectors.
template <int n>
struct Vertices {
  using Part = Numbers<n>;
  static Vertices at(const double* from) {
    return {numbers<n>(from), numbers<n>(from + n), numbers<n>(from + 2 * n)};
  }
  void write(double* to) const {  // not the whole, which compilers copy by way of memory
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) std::memcpy(to + i * n, &part[i], sizeof(Part));
  }
  Part squared_norms() const {
    if constexpr (n == 1) {
      return part[0] * part[0] + part[1] * part[1] + part[2] * part[2];
    } else {
      const Four a = part[0] * part[0], b = part[1] * part[1], c = part[2] * part[2];
      const Four ab_x = __builtin_shufflevector(a, b, 0, 3, 6, 6),
                 ab_y = __builtin_shufflevector(a, b, 1, 4, 7, 7),
                 ab_z = __builtin_shufflevector(a, b, 2, 5, 5, 5);
      return __builtin_shufflevector(ab_x, c, 0, 1, 2, 5) +
             __builtin_shufflevector(ab_y, c, 0, 1, 2, 6) +
             __builtin_shufflevector(ab_z, c, 0, 1, 4, 7);
    }
  }
  // this += factor times v, a factor each vertex.
  void add(const Part& factor, const Vertices& v) {
    if constexpr (n == 1) {
      for (int i = 0; i < 3; ++i) part[i] += factor * v.part[i];
    } else {
      part[0] += __builtin_shufflevector(factor, factor, 0, 0, 0, 1) * v.part[0];
      part[1] += __builtin_shufflevector(factor, factor, 1, 1, 2, 2) * v.part[1];
      part[2] += __builtin_shufflevector(factor, factor, 2, 3, 3, 3) * v.part[2];
    }
  }

  Part part[3];
};

// A spring without length has no direction: its force stays finite, and times d it vanishes.
constexpr double no_length = 1e-200;  // m
double length_of(double squared) { return std::max(std::sqrt(squared), no_length); }
Four length_of(const Four& squared) {
  Four lengths;
  for (int i = 0; i < 4; ++i) lengths[i] = length_of(squared[i]);
  return lengths;
}

// Calls act.operator()<n>(i) for numbers i ... i + n - 1 of those from begin to end.
template <class Act>
void in_fours(std::size_t begin, std::size_t end, Act act) {
  for (; begin + 4 <= end; begin += 4) act.template operator()<4>(begin);
  for (; begin < end; ++begin) act.template operator()<1>(begin);
}

// q -= scale W grad V of `count` stencils of a run, the first of them s, at p. The vertices of one
// role come after the other's: those of different roles overlap, and what a vector has written
// another one would wait for.
constexpr std::size_t most_at_once = 64;
void add_bending(const BendingStencil& s, std::size_t count, const double* w, const double* p,
                 double scale, double* q) {
  double sums[3 * most_at_once];
  in_fours(0, count, [&]<int n>(std::size_t k) {
    Vertices<n> sum{};
#pragma GCC unroll 4
    for (std::size_t role = 0; role < 4; ++role) {
      const auto at = Vertices<n>::at(p + 3 * (s.vertex[role] + k));
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) sum.part[i] += s.coefficient[role] * at.part[i];
    }
    sum.write(sums + 3 * k);
  });
  for (std::size_t role = 0; role < 4; ++role) {
    const double all = scale * s.stiffness * s.coefficient[role];
    in_fours(0, count, [&]<int n>(std::size_t k) {
      double* to = q + 3 * (s.vertex[role] + k);
      auto at = Vertices<n>::at(to);
      at.add(-(all * numbers<n>(w + s.vertex[role] + k)), Vertices<n>::at(sums + 3 * k));
      at.write(to);
    });
  }
}

// q += scale W f of n springs, the first of them e, at p: f pulls b towards a with k (|d| - r).
template <int n>
void add_springs(const Edge& e, const double* k, const double* r, const double* w, const double* p,
                 double scale, double* q) {
  auto d = Vertices<n>::at(p + 3 * e.b), a = Vertices<n>::at(p + 3 * e.a);
  for (int i = 0; i < 3; ++i) d.part[i] -= a.part[i];
  const auto f = scale * numbers<n>(k) * (1 - numbers<n>(r) / length_of(d.squared_norms()));
  a = Vertices<n>::at(q + 3 * e.a);
  a.add(f * numbers<n>(w + e.a), d);
  a.write(q + 3 * e.a);
  auto b = Vertices<n>::at(q + 3 * e.b);
  b.add(-(f * numbers<n>(w + e.b)), d);
  b.write(q + 3 * e.b);
}

void add_accelerations(const Problem& problem, const Positions& x, const Positions& shear_at,
                       double scale, Positions& y, WorkCounters& work) {
  const Eigen::Vector3d fall = scale * problem.gravity();
  y.colwise() += fall;
  const double* w = problem.inverse_mass().data();
  if (const Springs* shear = problem.shear()) {
    std::size_t begin = 0;
    for (const std::size_t run : problem.shear_runs()) {
      in_fours(begin, begin + run, [&]<int n>(std::size_t i) {
        add_springs<n>(shear->edges[i], &shear->stiffness[i], &shear->rest_length[i], w,
                       shear_at.data(), scale, y.data());
      });
      begin += run;
    }
    work.spring_evaluations += static_cast<std::int64_t>(shear->edges.size());
  }
  const Bending& bending = problem.bending();
  std::size_t begin = 0;
  for (const std::size_t run : problem.bending_runs())
    for (const std::size_t end = begin + run; begin < end;) {
      const std::size_t count = std::min(most_at_once, end - begin);
      add_bending(bending[begin], count, w, x.data(), scale, y.data());
      begin += count;
    }
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

// Curvature is the second difference 2 / (l_ab + l_bc) [(x_c - x_b) / l_bc - (x_b - x_a) / l_ab].
BendingStencil yarn_bending(int a, int b, int c, double l_ab, double l_bc, double rigidity) {
  const double share = 0.5 * (l_ab + l_bc);
  return {{a, b, c, a}, {1 / l_ab, -1 / l_ab - 1 / l_bc, 1 / l_bc, 0}, rigidity / share};
}

double bending_energy(const Bending& bending, const Eigen::Matrix3Xd& x) {
  double energy = 0;
  for (const BendingStencil& s : bending) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < 4; ++i) sum += s.coefficient[i] * x.col(s.vertex[i]);
    energy += 0.5 * s.stiffness * sum.squaredNorm();
  }
  return energy;
}

}  // namespace inextensible
