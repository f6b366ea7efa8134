// Proximal point iterations: with A = J W J^T and a tiny diagonal E,
//   (A + E) mu = J a + J' v,   a -= W J^T mu,
// which are refinement where A is regular, and where it is not need no decision about its rank: the
// part of mu in the null space of A moves nothing.
#include "solvers/systems/constrained_acceleration.h"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <limits>

#include "solvers/problem/edge_constraints.h"
#include "solvers/problem/forces.h"

namespace inextensible {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr double relative_shift = 1e-9;  // of the diagonal
constexpr double free_fall = 1e-12;      // of accelerations over rest lengths: rounding
constexpr int most_iterations = 50;      // one or two where A is regular

// J W J^T at gradients u, and a little on its diagonal.
Sparse regular_schur_complement(const EdgeConstraints& edges, const Eigen::Matrix3Xd& u,
                                int vertices) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < edges.count(); ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      entries.emplace_back(3 * edges.a[k] + axis, k, -std::sqrt(edges.wa[k]) * u(axis, k));
      entries.emplace_back(3 * edges.b[k] + axis, k, std::sqrt(edges.wb[k]) * u(axis, k));
    }
  }
  Sparse transposed(3 * vertices, edges.count());  // W^(1/2) J^T
  transposed.setFromTriplets(entries.begin(), entries.end());
  Sparse schur = (transposed.transpose() * transposed).pruned(0.0, 0.0);
  const Eigen::VectorXd diagonal = schur.diagonal();
  Sparse shift(edges.count(), edges.count());
  shift.setIdentity();
  for (int k = 0; k < edges.count(); ++k) {
    // An edge of no length has an empty row: any number will do.
    shift.coeffRef(k, k) = diagonal[k] > 0 ? relative_shift * diagonal[k] : 1;
  }
  return schur + shift;
}

}  // namespace

Positions constrained_acceleration(const Problem& problem, const State& state) {
  Positions a = Positions::Zero(3, problem.vertices());
  WorkCounters uncounted;
  add_acceleration(problem, state.x, 1, a, uncounted);
  if (problem.has_drag()) add_drag(problem, state.v, 1, a);
  for (const int vertex : problem.pinned()) a.col(vertex).setZero();
  if (problem.constraints() == 0) return a;

  const EdgeConstraints edges(problem, 1);
  Eigen::Matrix3Xd u(3, problem.constraints());
  edges.gradient(state.x, u);
  Eigen::VectorXd curvature(problem.constraints());  // J' v
  for (int k = 0; k < edges.count(); ++k) {
    curvature[k] = 2 * edges.inverse_rest_length[k] *
                   (state.v.col(edges.b[k]) - state.v.col(edges.a[k])).squaredNorm();
  }
  Eigen::VectorXd violation(problem.constraints());
  edges.rate(u, a, violation);
  violation += curvature;
  // What falls freely, as a cloth flat in the air does, needs no forces from its edges.
  const double largest = a.colwise().norm().maxCoeff() / problem.shortest_rest_length();
  if (violation.cwiseAbs().maxCoeff() <= free_fall * largest) return a;
  const Eigen::SimplicialLDLT<Sparse> ldlt(regular_schur_complement(edges, u, problem.vertices()));
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_iterations; ++i) {
    edges.rate(u, a, violation);
    violation += curvature;
    const double here = violation.norm();
    if (!(here < 0.5 * last)) break;  // rounding, or what no force can change
    last = here;
    violation = ldlt.solve(violation).eval();
    edges.apply(u, violation, a);
  }
  return a;
}

State start_half_step_back(const Problem& problem, const State& state, double h) {
  State start = state;
  start.v -= (0.5 * h) * constrained_acceleration(problem, state);
  return start;
}

}  // namespace inextensible
