// Pins that follow a body: what moves with a body at a steady speed is as what hangs from one at
// rest, seen by someone who walks past.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "solvers/problem/triangle_collider.h"
#include "solvers/registry.h"

namespace inextensible {
namespace {

constexpr int count = 8;         // vertices
constexpr double h = 1.0 / 200;  // s
const Eigen::Vector3d speed(0.7, -0.2, 0.4);

// A chain from a pin, beside a body far away.
std::shared_ptr<const Problem> chain(const BodyMotion& motion) {
  ProblemParts parts;
  parts.mass.assign(count, 0.1);
  parts.pinned = {0};
  for (int i = 0; i + 1 < count; ++i) parts.edges.push_back({i, i + 1});
  parts.rest_length.assign(count - 1, 0.1);
  TriangleMesh far;
  far.vertices = {{100, 0, 0}, {101, 0, 0}, {100, 1, 0}, {100, 0, 1}};
  far.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  parts.collider = std::make_shared<const TriangleCollider>(far, 0.0);
  parts.body_motion = motion;
  parts.pins_follow_body = static_cast<bool>(motion);
  return std::make_shared<const Problem>(parts);
}

State straight(const Eigen::Vector3d& velocity) {
  State state;
  state.x.setZero(3, count);
  for (int i = 0; i < count; ++i) state.x(0, i) = 0.1 * i;
  state.v = velocity.replicate(1, count);
  return state;
}

BodyMotion steady() {
  return [](double time) { return Pose{Eigen::Matrix3d::Identity(), time * speed}; };
}

class MovingPins : public testing::TestWithParam<const char*> {};

TEST_P(MovingPins, AtASteadySpeedChangeNothing) {
  const auto still = chain({}), moving = chain(steady());
  State at_rest = straight(Eigen::Vector3d::Zero()), moved = straight(speed);
  const auto one = make_stepper(GetParam(), still, {1e-9, 1, {}, &at_rest}),
             other = make_stepper(GetParam(), moving, {1e-9, 1, {}, &moved});
  for (int step = 0; step < 40; ++step) {
    ASSERT_TRUE(one->advance(at_rest, h));
    ASSERT_TRUE(other->advance(moved, h));
  }
  const Positions back = moved.x.colwise() - moved.time * speed;
  EXPECT_LT((back - at_rest.x).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_GT(at_rest.x.row(1).cwiseAbs().maxCoeff(), 0.1) << "it has swung";
}

INSTANTIATE_TEST_SUITE_P(Methods, MovingPins,
                         testing::Values("fast_projection", "fast_projection@bdf2", "icd",
                                         "shake"));

TEST(MovingPins, AreWhereTheBodyTakesThem) {
  const auto turning = [](double time) {
    Pose pose;
    pose.turn = Eigen::AngleAxisd(2 * time, Eigen::Vector3d::UnitY());
    pose.translation = time * speed;
    return pose;
  };
  State state = straight(Eigen::Vector3d::Zero());
  state.x.colwise() += Eigen::Vector3d(0.3, 0, 0);
  const Eigen::Vector3d pin = state.x.col(0);
  const auto stepper = make_stepper("fast_projection", chain(turning), {1e-6, 1, {}, &state});
  for (int step = 0; step < 100; ++step) ASSERT_TRUE(stepper->advance(state, h));
  EXPECT_LT((state.x.col(0) - turning(state.time)(pin)).norm(), 1e-10);
  EXPECT_LT(std::abs((state.x.col(1) - state.x.col(0)).norm() / 0.1 - 1), 1e-6);
}

}  // namespace
}  // namespace inextensible
