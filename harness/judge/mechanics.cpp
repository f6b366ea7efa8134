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

// |d|^2 / l^2: one root for all edges instead of one each.
double squared_ratio(const Problem& problem, const Positions& x, std::size_t k) {
  const auto [a, b] = problem.edges()[k];
  const double l = problem.rest_length()[k];
  return (x.col(b) - x.col(a)).squaredNorm() / (l * l);
}

struct SquaredRatios {
  double low = 1, high = 1;
  bool finite = true;
};

SquaredRatios squared_ratios(const Problem& problem, const Positions& x) {
  SquaredRatios all;
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    const double q = squared_ratio(problem, x, k);
    all.finite = all.finite && std::isfinite(q);
    all.low = std::min(all.low, q);
    all.high = std::max(all.high, q);
  }
  return all;
}

}  // namespace

StrainRange strain_range(const Problem& problem, const Positions& x) {
  const SquaredRatios ratios = squared_ratios(problem, x);
  if (!ratios.finite) return {infinity, infinity};
  const double stretch = std::sqrt(ratios.high) - 1;
  return {std::max(stretch, 1 - std::sqrt(ratios.low)), stretch};
}

WorstEdge worst_edge(const Problem& problem, const Positions& x) {
  const SquaredRatios ratios = squared_ratios(problem, x);
  const double stretch = std::sqrt(ratios.high) - 1, squeeze = 1 - std::sqrt(ratios.low);
  const double wanted = stretch >= squeeze ? ratios.high : ratios.low;
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    const double q = squared_ratio(problem, x, k);
    if (!ratios.finite && !std::isfinite(q)) return {infinity, k};
    if (ratios.finite && q == wanted) return {std::max(stretch, squeeze), k};
  }
  return {};  // every edge is as long as it should be, or there is none
}

void append_strains(const Problem& problem, const Positions& x, std::vector<double>& strains) {
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    const auto [a, b] = problem.edges()[k];
    strains.push_back(strain_size(x, a, b, problem.rest_length()[k]));
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
