// Constrained accelerations against dense algebra and mechanics, and what starting half a step back
// does for every method.
#include "solvers/systems/constrained_acceleration.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "solvers/registry.h"
#include "support/motion.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

using testing::Random;
using testing::RandomMesh;

RandomMesh falling(const RandomMesh& mesh, const Eigen::Vector3d& gravity) {
  ProblemParts parts = testing::parts_of(*mesh.problem);
  parts.gravity = gravity;
  return {std::make_shared<const Problem>(std::move(parts)), mesh.x};
}

// a = W f - W J^T lambda from the definitions.
TEST(ConstrainedAcceleration, IsThatOfDenseAlgebra) {
  testing::for_seeds(20, [&](testing::Random& random, std::uint64_t seed) {
    const RandomMesh mesh = falling(seed % 2 ? testing::random_mesh(random, 5, 6, 3)
                                             : testing::random_graph(random, 30, 20, 2, 1e-3),
                                    {1, -9.81, 2});
    const Problem& p = *mesh.problem;
    const State state = testing::moving_state(random, mesh, 1);
    const Eigen::MatrixXd j = testing::dense_gradient(p, state.x);
    const Eigen::MatrixXd wjt = testing::inverse_masses3(p).asDiagonal() * j.transpose();
    Positions fall = Positions::Zero(3, p.vertices());
    fall.colwise() += p.gravity();
    for (const int v : p.pinned()) fall.col(v).setZero();
    Eigen::VectorXd rhs = j * fall.reshaped();
    for (int k = 0; k < p.constraints(); ++k) {
      const auto [a, b] = p.edges()[k];
      rhs[k] += 2 / p.rest_length()[k] * (state.v.col(b) - state.v.col(a)).squaredNorm();
    }
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

// Every row says rightly what its velocities are: a free net that moves then falls exactly.
TEST(StartHalfStepBack, LetsEveryMethodFallExactly) {
  Random random(3);
  const RandomMesh mesh = falling(testing::random_mesh(random, 5, 5, 0), {0, -9.81, 0});
  for (const Backend& row : backends()) {
    SCOPED_TRACE(row.name);
    State state{mesh.x, Positions::Zero(3, 25), 0};
    state.v.colwise() += Eigen::Vector3d(1, 2, 3);
    const State begin = state;
    const auto stepper = make_stepper(row.name, mesh.problem, {1e-3, 1, {}});
    using testing::h;
    if (row.velocities == Velocities::half_step)
      state = start_half_step_back(*mesh.problem, state, h);
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(stepper->advance(state, h));
    Positions exact = begin.x + 0.5 * begin.v;
    exact.row(1).array() -= 0.5 * 9.81 * 0.25;
    EXPECT_LT((state.x - exact).cwiseAbs().maxCoeff(), 1e-12);
  }
}

}  // namespace
}  // namespace inextensible
