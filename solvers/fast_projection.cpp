// Algorithm 1 line by line. With mu = h^2 dlambda the step h drops out of equations 5 and 7:
//   (J W J^T) mu = C(x_j),   x_{j+1} = x_j - W J^T mu,   J = J(x_j).
// Loops: one pass over edges, one assembly, one factorization, one solve and one pass over edges an
// iteration.
#include "fast_projection.h"

namespace inextensible {

FastProjection::FastProjection(const Problem& problem, const Settings& settings)
    : system_(problem, settings.strain_limit, settings.linear_solver),
      max_iterations_(settings.max_iterations),
      min_iterations_(settings.min_iterations),
      u_(3, problem.constraints()),
      mu_(problem.constraints()) {}

StepResult FastProjection::apply(const Positions& /*x_start*/, double /*h*/, Positions& x,
                                 WorkCounters& work) {
  const EdgeConstraints& edges = system_.edges();
  for (int j = 0;; ++j) {
    if (edges.linearize(x, u_, mu_) && j >= min_iterations_) return {Status::ok, j};
    if (j == max_iterations_) return refuse(Status::not_converged, j, edges, x, "iteration limit");
    if (!system_.factor(u_, work))
      return refuse(Status::singular, j, edges, x, "J W J^T is not positive definite");
    system_.solve(mu_, work);  // (7)
    edges.apply(u_, mu_, x);   // (5)
  }
}

}  // namespace inextensible
