// Soft step: the law of a hanging yarn, and a single pendulum against its own formulas.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "solvers/problem/edge_constraints.h"
#include "solvers/registry.h"

namespace inextensible {
namespace {

constexpr double acceleration = 9.81;

std::shared_ptr<const Problem> yarn(int links, double length, double mass) {
  ProblemParts parts;
  parts.gravity = {0, -acceleration, 0};
  parts.mass.assign(links + 1, mass);
  parts.pinned = {0};
  for (int i = 0; i < links; ++i) parts.edges.push_back({i, i + 1});
  parts.rest_length.assign(links, length);
  return std::make_shared<const Problem>(parts);
}

// At rest the impulses are the loads, and what is soft in them leaves link k longer by
// load / (m_k omega^2), omega = 2 pi frequency / h, m_k = 1 / (w_a + w_b).
TEST(SoftStep, LeavesAHangingYarnTheElongationOfItsSprings) {
  constexpr int links = 10;
  constexpr double length = 0.1, mass = 0.1;
  const auto problem = yarn(links, length, mass);
  for (const double step : {0.004, 0.001}) {
    for (const double frequency : {0.25, 0.5}) {
      SCOPED_TRACE("step " + std::to_string(step) + ", frequency " + std::to_string(frequency));
      const auto stepper =
          make_stepper("soft_step", problem, {0.01, 1, {{"frequency", frequency}}});
      State state{Positions::Zero(3, links + 1), Positions::Zero(3, links + 1), 0};
      for (int i = 0; i <= links; ++i) state.x(1, i) = -i * length;
      while (state.time < 20) ASSERT_TRUE(stepper->advance(state, step));
      const double omega = 2 * std::numbers::pi * frequency / step;
      for (int k = 1; k <= links; ++k) {
        const double load = (links - k + 1) * mass * acceleration;
        const double longer = load / ((k == 1 ? mass : mass / 2) * omega * omega);
        const double now = (state.x.col(k) - state.x.col(k - 1)).norm() - length;
        EXPECT_NEAR(now, longer, 1e-3 * longer) << "link " << k;
      }
    }
  }
}

// A link that turns about a pin: the step's impulse is along its direction at the start, and the
// second stage leaves no velocity along it at the end.
TEST(SoftStep, LeavesNoVelocityAlongALink) {
  const auto problem = yarn(1, 1, 1);
  const double step = 0.01;
  State state{Positions::Zero(3, 2), Positions::Zero(3, 2), 0};
  state.x(0, 1) = 1;
  state.v(1, 1) = 2;
  const auto stepper = make_stepper("soft_step", problem, {});
  ASSERT_TRUE(stepper->advance(state, step));
  EXPECT_NEAR(state.x(0, 1), 1, 1e-15);
  EXPECT_NEAR(state.x(1, 1), step * (2 - step * acceleration), 1e-15);
  const Eigen::Vector3d d = state.x.col(1);
  EXPECT_NEAR(state.v.col(1).dot(d), 0, 1e-15);
  const Eigen::Vector3d free(0, 2 - step * acceleration, 0);
  EXPECT_NEAR((state.v.col(1) - (free - d.dot(free) / d.squaredNorm() * d)).norm(), 0, 1e-14);
}

// Elongations acceleration as h^2 in motion too.
TEST(SoftStep, StretchesASwingingYarnWithTheSquareOfTheStep) {
  constexpr int links = 10;
  const auto problem = yarn(links, 0.1, 0.1);
  const auto largest = [&](double step) {
    State state{Positions::Zero(3, links + 1), Positions::Zero(3, links + 1), 0};
    for (int i = 0; i <= links; ++i) state.x(0, i) = 0.1 * i;
    const auto stepper = make_stepper("soft_step", problem, {});
    const EdgeConstraints edges(*problem, 1);
    double worst = 0;
    while (state.time < 0.3) {
      EXPECT_TRUE(stepper->advance(state, step));
      worst = std::max(worst, std::abs(edges.worst(state.x).strain));
    }
    return worst;
  };
  EXPECT_NEAR(std::log2(largest(1e-3) / largest(5e-4)), 2, 0.3);
}

}  // namespace
}  // namespace inextensible
