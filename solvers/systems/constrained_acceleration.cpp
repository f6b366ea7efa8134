// Proximal point iterations: with A = J W J^T and a tiny diagonal E,
//   (A + E) mu = J a + J' v,   a -= W J^T mu,
// which are refinement where A is regular, and where it is not need no decision about its rank: the
// part of mu in the null space of A moves nothing.
#include "solvers/systems/constrained_acceleration.h"

#include "solvers/linear/spd_solver.h"
#include "solvers/problem/forces.h"
#include "solvers/systems/schur_complement.h"

namespace inextensible {

constexpr double relative_shift = 1e-9;  // of the diagonal
constexpr double free_fall = 1e-12;      // of accelerations over rest lengths: rounding
constexpr int most_iterations = 50;      // one or two where A is regular

Positions constrained_acceleration(const Problem& problem, const State& state) {
  Positions a = Positions::Zero(3, problem.vertices());
  WorkCounters uncounted;
  add_acceleration(problem, state.x, 1, a, uncounted);
  if (problem.has_drag()) add_drag(problem, state.v, 1, a);
  for (const int vertex : problem.pinned()) a.col(vertex).setZero();
  if (problem.constraints() == 0) return a;

  const EdgeConstraints edges(problem, 1, elimination_order(problem));
  Eigen::Matrix3Xd u(3, problem.constraints());
  edges.gradient(state.x, u);
  Eigen::VectorXd curvature(problem.constraints());  // J' v
  for (int k = 0; k < edges.count(); ++k)
    curvature[k] = 2 * edges.inverse_rest_length[k] *
                   (state.v.col(edges.b[k]) - state.v.col(edges.a[k])).squaredNorm();
  Eigen::VectorXd violation(problem.constraints());
  edges.rate(u, a, violation);
  violation += curvature;
  // What falls freely, as a cloth flat in the air does, needs no forces from its edges.
  const double largest = a.colwise().norm().maxCoeff() / problem.shortest_rest_length();
  if (violation.cwiseAbs().maxCoeff() <= free_fall * largest) return a;
  const SchurComplement schur(edges, problem.vertices(), SymmetricPattern::Triangle::lower);
  const SymmetricPattern& pattern = schur.pattern();
  const auto solver = make_spd_solver("multifrontal", pattern);
  schur.assemble(u, solver->values());
  for (int k = 0; k < edges.count(); ++k) {
    double& diagonal = solver->values()[pattern.diagonal(k)];
    // An edge of no length has an empty row: any number will do.
    diagonal = diagonal > 0 ? (1 + relative_shift) * diagonal : 1;
  }
  if (!solver->factor()) return a;
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_iterations; ++i) {
    edges.rate(u, a, violation);
    violation += curvature;
    const double here = violation.norm();
    if (!(here < 0.5 * last)) break;  // rounding, or what no force can change
    last = here;
    solver->solve(violation.data());
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
