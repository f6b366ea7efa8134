// Bending: energies of shapes of known curvature, and forces against the energy's differences.
#include "solvers/problem/bending.h"

#include <Eigen/Geometry>
#include <numbers>

#include "solvers/problem/forces.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

using Eigen::Vector3d;

// In links of two lengths, one after the other.
TEST(YarnBending, OfACircleIsHalfItsRigidityTimesCurvatureSquaredTimesLength) {
  constexpr double radius = 0.7, rigidity = 0.3;
  double last = 0;
  for (const int n : {20, 40}) {
    const double sector = 2 * std::numbers::pi / n;
    const double link[] = {2 * radius * std::sin(0.6 * sector),
                           2 * radius * std::sin(0.4 * sector)};
    Positions x(3, n);
    Bending bending;
    for (int i = 0; i < n; ++i) {
      const double angle = sector * (i + 0.2 * (i % 2));
      x.col(i) << radius * std::cos(angle), radius * std::sin(angle), 0.2;
      bending.push_back(
          yarn_bending(i, (i + 1) % n, (i + 2) % n, link[i % 2], link[(i + 1) % 2], rigidity));
    }
    const double exact = 0.5 * rigidity / (radius * radius) * 2 * std::numbers::pi * radius;
    const double error = std::abs(bending_energy(bending, x) / exact - 1);
    if (n == 40) {
      EXPECT_NEAR(std::log2(last / error), 2, 0.1);
    }
    last = error;
  }
  EXPECT_LT(last, 0.01);
}

// Shear, bending and gravity together, on a sheet crumpled at random: stencils of consecutive
// vertices, which are found side by side, and others.
TEST(Forces, AreTheEnergysDifferences) {
  testing::Random random(7);
  constexpr int side = 7, n = side * side;
  Positions flat(3, n);
  ProblemParts parts;
  parts.bending.push_back({{0, 8, 3, 20}, {2, -3, 0.5, 0.5}, 0.1});
  parts.bending.push_back(yarn_bending(0, 1, 2, 0.3, 0.35, 0.2));
  parts.shear = Springs{{{0, 9}, {1, 4}, {1, 4}}, {0.4, 0.5, 0.4}, {3, 2, 1}};
  for (int i = 0; i < n; ++i) {
    parts.mass.push_back(0.5 + 0.1 * i);
    flat.col(i) << i % side / 6.0, i / side / 6.0, 0;
    if (i % side + 1 == side || i + side >= n) continue;
    parts.bending.push_back({{i, i + 1, i + side, i + side + 1}, {1, -1, -1, 1}, 0.1});
    for (const Edge diagonal : {Edge{i, i + side + 1}, Edge{i + 1, i + side}}) {
      parts.shear->edges.push_back(diagonal);
      parts.shear->rest_length.push_back(0.3 + 0.01 * i);
      parts.shear->stiffness.push_back(3 - 0.05 * i);
    }
    parts.bending.push_back(yarn_bending(i, i + 1, (i + 2) % n, 0.3, 0.3, 0.2));
    parts.bending.push_back(yarn_bending(i, i + side, (i + 2 * side) % n, 0.3, 0.3, 0.2));
  }
  parts.pinned = {3};
  const Problem problem(parts);
  const Positions x = flat + 0.2 * testing::random_matrix(random, 3, n);
  WorkCounters work;
  Positions force = Positions::Zero(3, n), still = force;
  add_forces(problem, x, x, still, force, work);
  EXPECT_EQ(work.spring_evaluations,
            static_cast<std::int64_t>(parts.shear->edges.size() + parts.bending.size()));
  const double d = 1e-6;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (i / 3 == parts.pinned[0]) continue;
    Positions up = x, down = x;
    up(i) += d;
    down(i) -= d;
    EXPECT_NEAR(force(i),
                -(potential_energy(problem, up) - potential_energy(problem, down)) / (2 * d), 1e-6);
  }
}

TEST(Problem, RefusesPartsThatDoNotFit) {
  const std::function<void(ProblemParts&)> misfits[] = {
      [](ProblemParts& parts) { parts.bending = {yarn_bending(0, 1, 3, 1, 1, 1)}; },
      [](ProblemParts& parts) { parts.bending = {yarn_bending(0, 1, 2, 1, 1, -1)}; },
      [](ProblemParts& parts) { parts.drag.assign(2, 1); },
      [](ProblemParts& parts) { parts.drag.assign(3, -1); },
      [](ProblemParts& parts) { parts.pins_follow_body = true; },  // of none
      [](ProblemParts& parts) {
        parts.body_motion = [](double) { return Pose{Eigen::Matrix3d::Identity(), {0, 0, 0}}; };
      }};
  for (const auto& change : misfits) {
    ProblemParts parts;
    parts.mass = {1, 1, 1};
    EXPECT_NO_THROW(Problem{parts});
    change(parts);
    EXPECT_THROW(Problem{parts}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace inextensible
