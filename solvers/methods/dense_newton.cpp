// Two rows that do not compete.
//
// dense_newton: the M-closest point of {C = 0} (ICD = SAP, Goldenthal et al. 2007, Theorem 1) to
// 1e-12, by dense Newton with full pivoting: slow and obvious, what tests compare with for small n.
//
// null: the unconstrained step alone, which measures what the scene and the harness cost.
#include <Eigen/Dense>
#include <stdexcept>

#include "solvers/methods/rows.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {
namespace {

constexpr int largest_problem = 600;  // vertices
constexpr double tolerance = 1e-12;   // of C and F, in rest lengths

// J (m x 3n) with zero columns at pinned vertices.
Eigen::MatrixXd dense_jacobian(const EdgeConstraints& edges, const Positions& x) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(edges.count(), 3 * x.cols());
  for (int k = 0; k < edges.count(); ++k) {
    const Eigen::RowVector3d u =
        2 * edges.inverse_rest_length[k] * (x.col(edges.b[k]) - x.col(edges.a[k])).transpose();
    if (edges.wa[k] > 0) jacobian.block<1, 3>(k, 3 * edges.a[k]) = -u;
    if (edges.wb[k] > 0) jacobian.block<1, 3>(k, 3 * edges.b[k]) = u;
  }
  return jacobian;
}

class DenseNewton final : public VelocityFilter {
 public:
  DenseNewton(const Problem& problem, const BackendOptions& /*options*/)
      : problem_(problem), edges_(problem, tolerance) {
    if (problem.vertices() > largest_problem)
      throw std::invalid_argument("solver 'dense_newton' is dense, for at most " +
                                  std::to_string(largest_problem) + " vertices; this problem has " +
                                  std::to_string(problem.vertices()));
  }

  StepResult apply(const Positions& /*x_start*/, double /*h*/, Iterate iterate,
                   WorkCounters& work) override {
    Positions& x = iterate;
    const Eigen::Index n3 = 3 * x.cols(), m = edges_.count();
    if (m == 0) return {};  // no constraint: the candidate it is
    const Positions x0 = x;
    Eigen::VectorXd mass(n3), mu = Eigen::VectorXd::Zero(m), c(m);
    for (Eigen::Index i = 0; i < n3; ++i) mass[i] = problem_.mass()[i / 3];
    Eigen::Matrix3Xd u(3, m);
    const double goal = tolerance * problem_.shortest_rest_length();
    constexpr int iteration_limit = 200;
    for (int j = 0; j < iteration_limit; ++j) {
      edges_.linearize(x, u, c);
      const Eigen::MatrixXd jacobian = dense_jacobian(edges_, x);
      const Positions displacement = x - x0;
      const Eigen::VectorXd force =
          mass.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(displacement.data(), n3)) +
          jacobian.transpose() * mu;
      if (c.cwiseAbs().maxCoeff() <= goal &&
          (force.cwiseQuotient(mass)).cwiseAbs().maxCoeff() <= goal)
        return {Status::ok, j};
      Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n3 + m, n3 + m);
      kkt.diagonal().head(n3) = mass;
      for (Eigen::Index k = 0; k < m; ++k) {
        const double curvature = 2 * mu[k] * edges_.inverse_rest_length[k];
        for (int axis = 0; axis < 3; ++axis) {
          const Eigen::Index a = 3 * edges_.a[k] + axis, b = 3 * edges_.b[k] + axis;
          if (edges_.wa[k] > 0) kkt(a, a) += curvature;
          if (edges_.wb[k] > 0) kkt(b, b) += curvature;
          if (edges_.wa[k] > 0 && edges_.wb[k] > 0) kkt(a, b) = kkt(b, a) = kkt(a, b) - curvature;
        }
      }
      kkt.bottomLeftCorner(m, n3) = jacobian;
      kkt.topRightCorner(n3, m) = jacobian.transpose();
      Eigen::VectorXd rhs(n3 + m);
      rhs << -force, -c;
      const Eigen::VectorXd step = kkt.fullPivLu().solve(rhs);
      ++work.assemblies;
      ++work.factorizations;
      ++work.back_solves;
      // A vertex moves by a quarter of an edge at most: slow, but near the closest solution.
      const double longest = step.head(n3).cwiseAbs().maxCoeff();
      const double scale = std::min(1.0, 0.25 * problem_.shortest_rest_length() / longest);
      x += scale * Eigen::Map<const Positions>(step.data(), 3, x.cols());
      mu += scale * step.tail(m);
      if (!x.allFinite()) break;
    }
    return refuse(Status::not_converged, iteration_limit, edges_, x, "iteration limit");
  }

 private:
  const Problem& problem_;
  EdgeConstraints edges_;
};

struct Unconstrained final : VelocityFilter {
  Unconstrained(const Problem& /*problem*/, const BackendOptions& /*options*/) {}
  StepResult apply(const Positions& /*x_start*/, double /*h*/, Iterate /*x*/,
                   WorkCounters& /*work*/) override {
    return {};
  }
};

}  // namespace

Backend dense_newton_row() {
  return {.name = "dense_newton",
          .summary = "dense Newton to 1e-12, small problems: what tests compare with",
          .strain_control = StrainControl::none,
          .contestant = false,
          .make_filter = make_filter<DenseNewton>,
          .citation = "Goldenthal et al. 2007",
          .label = "dense Newton (no contestant)"};
}

Backend null_row() {
  return {.name = "null",
          .summary = "unconstrained step only: what the scene and the harness cost",
          .strain_control = StrainControl::none,
          .contestant = false,
          .make_filter = make_filter<Unconstrained>,
          .label = "scene without inextensibility"};
}

}  // namespace inextensible
