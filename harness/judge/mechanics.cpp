#include "harness/judge/mechanics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "solvers/problem/forces.h"

namespace harness {
namespace {

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
  const Problem& problem = *scene.problem;
  return problem.total_mass() * problem.gravity().norm() * scene.size +
         inextensible::kinetic_energy(problem, scene.start.v);
}

void raise(double& figure, double value) {
  figure = std::isnan(figure) ? value : std::max(figure, value);
}

double shadow_area(const Scene& scene, const Positions& x, double reach, int pixels) {
  const double pixel = 2 * reach / pixels;
  std::vector<char> dark(pixels * pixels, 0);
  const auto index = [&](double coordinate) {
    return std::clamp(static_cast<int>((coordinate + reach) / pixel), 0, pixels - 1);
  };
  for (const auto& [a, b, c] : scene.triangles) {
    const Eigen::Vector2d p(x(0, a), x(2, a)), q(x(0, b), x(2, b)), r(x(0, c), x(2, c));
    const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
      return u.x() * v.y() - u.y() * v.x();
    };
    const double area = cross(q - p, r - p);
    if (area == 0) continue;
    const Eigen::Vector2d low = p.cwiseMin(q).cwiseMin(r), high = p.cwiseMax(q).cwiseMax(r);
    for (int j = index(low.y()); j <= index(high.y()); ++j) {
      for (int i = index(low.x()); i <= index(high.x()); ++i) {
        const Eigen::Vector2d s((i + 0.5) * pixel - reach, (j + 0.5) * pixel - reach);
        if (cross(q - p, s - p) / area >= 0 && cross(r - q, s - q) / area >= 0 &&
            cross(p - r, s - r) / area >= 0)
          dark[j * pixels + i] = 1;
      }
    }
  }
  const auto count = std::count(dark.begin(), dark.end(), 1);
  return static_cast<double>(count) * pixel * pixel;
}

}  // namespace harness
