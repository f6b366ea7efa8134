// Constrained accelerations against dense algebra and mechanics. (Starting half a step back is what
// lets every method fall exactly: every_method_test.cpp.)
#include "solvers/systems/constrained_acceleration.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "support/motion.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

// a = W f - W J^T lambda from the definitions.
TEST(ConstrainedAcceleration, IsThatOfDenseAlgebra) {
  testing::for_seeds(20, [&](testing::Random& random, std::uint64_t seed) {
    const auto mesh = seed % 2 ? testing::random_mesh(random, 5, 6, 3)
                               : testing::random_graph(random, 30, 20, 2, 1e-3);
    ProblemParts parts = testing::parts_of(*mesh.problem);
    parts.gravity = {1, -9.81, 2};
    const Problem p(parts);
    const State state = testing::moving_state(random, mesh, 1);
    const Eigen::MatrixXd j = testing::dense_gradient(p, state.x);
    const Eigen::MatrixXd wjt = testing::inverse_masses3(p).asDiagonal() * j.transpose();
    Positions fall = p.gravity().replicate(1, p.vertices());
    for (const int v : p.pinned()) fall.col(v).setZero();
    // J' v: J is linear in x.
    const Eigen::VectorXd curvature = testing::dense_gradient(p, state.v) * state.v.reshaped();
    const Eigen::VectorXd rhs = j * fall.reshaped() + curvature;
    const Eigen::VectorXd expected = fall.reshaped() - wjt * (j * wjt).ldlt().solve(rhs);
    const Positions a = constrained_acceleration(p, state);
    EXPECT_LT((a.reshaped() - expected).norm(), 1e-8 * expected.norm());
    for (const int v : p.pinned()) EXPECT_EQ(a.col(v), Eigen::Vector3d::Zero());
  });
}

// A straight row of unequal masses between two pins: J W J^T is singular.
TEST(ConstrainedAcceleration, OfATautRowIsWhatTheRowCannotHinder) {
  Positions x = Positions::Zero(3, 5);
  x.row(0) << 0, 1, 2, 3, 4;
  ProblemParts parts =
      testing::parts_at_rest(x, {{0, 1}, {1, 2}, {2, 3}, {3, 4}}, {1, 2, 0.5, 3, 1}, {0, 4});
  parts.gravity = {4, -9, 0};
  const Positions a = constrained_acceleration(Problem(parts), {x, Positions::Zero(3, 5), 0});
  for (int v = 1; v < 4; ++v) {
    EXPECT_NEAR((a.col(v) - Eigen::Vector3d(0, -9, 0)).norm(), 0, 1e-6);
  }
}

// An edge of no length has no direction, and no force.
TEST(ConstrainedAcceleration, KnowsNoForceOfAnEdgeWithoutLength) {
  ProblemParts parts;
  parts.mass = {1, 1, 1};
  parts.pinned = {0};
  parts.edges = {{0, 1}, {1, 2}};
  parts.rest_length = {1, 1};
  Positions x = Positions::Zero(3, 3);
  x.row(1) << 0, -1, -1;
  const Positions a = constrained_acceleration(Problem(parts), {x, Positions::Zero(3, 3), 0});
  EXPECT_NEAR(a.col(1).norm(), 0, 1e-12);
  EXPECT_NEAR((a.col(2) - parts.gravity).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace inextensible
