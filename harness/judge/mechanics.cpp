#include "harness/judge/mechanics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/problem/forces.h"

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::Problem;
using inextensible::State;

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

StrainRange strain_range(const Problem& problem, const Positions& x) {
  double low = 1, high = 1;  // |d|^2 / l^2: one root for all edges instead of one each
  std::size_t shortest = 0, longest = 0;
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    const auto [a, b] = problem.edges()[k];
    const double l = problem.rest_length()[k];
    const double q = (x.col(b) - x.col(a)).squaredNorm() / (l * l);
    if (!std::isfinite(q)) return {infinity, infinity, k};
    if (q < low) {
      low = q;
      shortest = k;
    }
    if (q > high) {
      high = q;
      longest = k;
    }
  }
  const double stretch = std::sqrt(high) - 1, squeeze = 1 - std::sqrt(low);
  return {std::max(stretch, squeeze), stretch, stretch >= squeeze ? longest : shortest};
}

void append_strains(const Problem& problem, const Positions& x, std::vector<double>& strains) {
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    const auto [a, b] = problem.edges()[k];
    strains.push_back(std::abs((x.col(b) - x.col(a)).norm() / problem.rest_length()[k] - 1));
  }
}

Eigen::Vector3d linear_momentum(const Problem& problem, const Positions& v) {
  return v * Eigen::Map<const Eigen::VectorXd>(problem.mass().data(), problem.vertices());
}

Eigen::Vector3d angular_momentum(const Problem& problem, const State& state) {
  // Masses times positions: the first moment.
  const Eigen::Vector3d centre = linear_momentum(problem, state.x) / problem.total_mass();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    const Eigen::Vector3d arm = state.x.col(i) - centre, velocity = state.v.col(i);
    sum += problem.mass()[i] * arm.cross(velocity);
  }
  return sum;
}

double total_energy(const Problem& problem, const State& state) {
  return inextensible::potential_energy(problem, state.x) +
         inextensible::kinetic_energy(problem, state.v);
}

double energy_scale(const Scene& scene) {
  const inextensible::Problem& problem = *scene.problem;
  return problem.total_mass() * problem.gravity().norm() * scene.size +
         inextensible::kinetic_energy(problem, scene.start.v);
}

void raise(double& figure, double value) {
  figure = std::isnan(figure) ? value : std::max(figure, value);
}

}  // namespace harness
