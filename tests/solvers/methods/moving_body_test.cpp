// Bodies that move, and pins with them: a turntable, and Galileo's relativity with every backend.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "solvers/problem/triangle_collider.h"
#include "solvers/registry.h"
#include "support/contact.h"
#include "support/param_name.h"
#include "support/random_mesh.h"

namespace inextensible {
namespace {

using Eigen::Vector3d;
using testing::Random;
using testing::uniform;

constexpr double free_fall = 9.81, tick = 1.0 / 128;  // m/s^2; s, so that times are exact

// A vertex is carried round where friction bears its centripetal acceleration, and flung off where
// not.
TEST(MovingBody, ATurntableHoldsWhatFrictionCanHold) {
  constexpr double rate = 4, radius = 0.5, needed = rate * rate * radius / free_fall;
  const auto turn = [](double time) {
    return Eigen::AngleAxisd(rate * time, Vector3d::UnitY()).toRotationMatrix();
  };
  const auto after = [&](double friction) {
    ProblemParts parts;
    parts.mass = {0.3};
    parts.collider = std::make_shared<const testing::Ground>(Vector3d(0, 1, 0), 0, friction);
    parts.body_motion = [=](double time) { return Pose{turn(time), Vector3d::Zero()}; };
    State state{Vector3d(radius, 0, 0), Vector3d(0, 0, -rate * radius), 0};  // with the table
    const auto stepper =
        make_stepper("fast_projection", std::make_shared<const Problem>(parts), {0.01, 1});
    while (state.time < 0.5) EXPECT_TRUE(stepper->advance(state, tick));
    return state;
  };
  const State held = after(1.1 * needed), flung = after(0.5 * needed);
  EXPECT_LT((held.x.col(0) - turn(held.time) * Vector3d(radius, 0, 0)).norm(), 1e-12);
  EXPECT_GT(flung.x.col(0).norm(), 1.1 * radius);
}

class MovingBodies : public ::testing::TestWithParam<const char*> {};

// Cloth that falls onto a ball, free or pinned beside it, sees no difference between a ball at rest
// and both in the same steady motion, but for what iterations stop at: a method that did not carry
// contacts along would be wrong by 0.1, one that left pins behind by 0.6.
TEST_P(MovingBodies, SeesNoSteadyMotionThatItShares) {
  const Vector3d velocity(0.7, -0.4, 1.1);
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitY()).toRotationMatrix();
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto run = [&](bool moves) {
      Random random(seed);
      const Vector3d middle(2, -1.15 + uniform(random, -0.1, 0.1), 1.5);
      const auto mesh = testing::random_mesh(random, 4, 5, seed == 0);
      ProblemParts parts = testing::parts_of(*mesh.problem);
      parts.gravity = {0, -free_fall, 0};
      // In coordinates of its own that are turned, which its pose turns back.
      TriangleMesh ball = icosphere(middle, 0.9, 2);
      if (moves)
        for (Vector3d& v : ball.vertices) v = turned.transpose() * v;
      parts.collider = std::make_shared<const TriangleCollider>(ball, 0.3);
      if (moves) parts.body_motion = [=](double time) { return Pose{turned, time * velocity}; };
      parts.pins_follow_body = moves;
      State state{mesh.x, Positions::Zero(3, mesh.x.cols()), 0};
      if (moves) state.v.colwise() += velocity;
      Settings settings;
      if (find_backend(GetParam())->strain_control == StrainControl::stiffness)
        settings["stiffness"] = 2000.0;
      const auto stepper = make_stepper(GetParam(), std::make_shared<const Problem>(parts),
                                        {0.01, 1, settings, &state});
      for (int step = 0; step < 56; ++step) EXPECT_TRUE(stepper->advance(state, tick));
      EXPECT_GT(stepper->work().contacts, 0) << "nothing touched: this tests nothing";
      if (moves) state.x.colwise() -= state.time * velocity;
      return state.x;
    };
    EXPECT_LT((run(true) - run(false)).cwiseAbs().maxCoeff(), 5e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(All, MovingBodies, ::testing::ValuesIn(names::rows_that([](auto& row) {
                           return row.contestant && row.takes_collider;
                         })),
                         names::contestant_name);

}  // namespace
}  // namespace inextensible
