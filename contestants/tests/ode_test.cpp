#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "contestants/tests/known_scenes.h"

namespace engines {
namespace {

using inextensible::Settings;
using inextensible::State;

const std::string solver = "engine_ode";
const Settings passes{{"solver", std::string("passes")}, {"iterations", 200.0}};

class Ode : public testing::Test {
 protected:
  void SetUp() override { load(PLUGIN); }
};

// Its time stepper is of first order.
TEST_F(Ode, SwingsAsAPendulum) {
  const double coarse = pendulum_error(solver, 1000), fine = pendulum_error(solver, 2000);
  EXPECT_LT(fine, 0.01);
  EXPECT_NEAR(std::log2(coarse / fine), 1, 0.1);
}

// A chain that hangs at rest stays: the factorization finds its tensions, and few passes do not.
TEST_F(Ode, HangsAtRest) {
  constexpr int links = 10;
  Scene scene = chain(links);
  scene.start.x.row(1) = -scene.start.x.row(0);
  scene.start.x.row(0).setZero();
  EXPECT_LT(distance(run(solver, scene, 0.01, 100).x, scene.start.x), 1e-9);
  const State strained =
      run(solver, scene, 0.01, 1, {{"solver", std::string("passes")}, {"iterations", 1.0}});
  EXPECT_GT(largest_strain(scene, strained), 1e-4);
  EXPECT_LT(distance(run(solver, scene, 0.01, 1, passes).x, scene.start.x), 1e-6);
}

// Where both find the same multipliers they move the same. Nothing is damped: what a corrected
// step loses vanishes with the step, as does the strain.
TEST_F(Ode, PassesConvergeToTheFactorization) {
  const Scene scene = swirling_chain(5);
  const State direct = run(solver, scene, 1e-3, 100);
  EXPECT_LT(distance(direct.x, run(solver, scene, 1e-3, 100, passes).x), 1e-6);
  EXPECT_LT(largest_strain(scene, direct), 1e-3);
  const State finer = run(solver, scene, 5e-4, 200);
  EXPECT_LT(largest_strain(scene, finer), 0.6 * largest_strain(scene, direct));
  EXPECT_NEAR(angular_momentum(scene, finer).y(), angular_momentum(scene, scene.start).y(), 1e-2);
}

// Forces along directions at the start of a step keep the angular momentum, and the corrections of
// drift along the same do.
TEST_F(Ode, NetKeepsSpinning) {
  const Scene scene = spinning_net(4, 2 * std::numbers::pi);
  const State end = run(solver, scene, 1e-3, 500);
  EXPECT_NEAR(angular_momentum(scene, end).y() / angular_momentum(scene, scene.start).y(), 1, 1e-9);
  EXPECT_LT(largest_strain(scene, end), 1e-3);
}

TEST_F(Ode, TakesAndGivesStates) {
  Scene scene = spinning_net(4, 0);
  scene.start.v.colwise() = Eigen::Vector3d(3, -2, 1);
  const State after = run(solver, scene, 0.01, 1);
  EXPECT_LT(distance(after.x, scene.start.x + 0.01 * scene.start.v), 1e-14);
  EXPECT_LT(distance(run(solver, scene, 0.01, 1000).v, scene.start.v), 1e-10);  // never disabled
}

TEST_F(Ode, TakesForces) {
  inextensible::ProblemParts parts;
  parts.mass = {1, 1};
  parts.gravity.setZero();
  parts.shear = inextensible::Springs{{{0, 1}}, {1}, {50}};
  Scene scene{std::make_shared<const inextensible::Problem>(parts), {}};
  scene.start.x.setZero(3, 2);
  scene.start.v.setZero(3, 2);
  scene.start.x.row(0) << -0.55, 0.55;
  const State after = run(solver, scene, std::numbers::pi / 10 / 3200, 3200);  // half a period
  EXPECT_NEAR(after.x(0, 1), 0.45, 1e-4);
  EXPECT_NEAR(after.x(0, 0), -0.45, 1e-4);
}

TEST_F(Ode, RefusesWithoutTrace) {
  const Scene scene = chain(5);
  State fast = scene.start;
  fast.v.rightCols(2).setConstant(1e300);
  expect_refusal_without_trace(solver, scene, fast, 1e10);
}

// Another stepper's random numbers are not taken.
TEST_F(Ode, SteppersDoNotDisturbEachOther) {
  const Scene scene = swirling_chain(5);
  const Settings few{{"solver", std::string("passes")}, {"iterations", 2.0}};
  const State alone = run(solver, scene, 1e-3, 40, few);
  const auto one = make(solver, scene, few), other = make(solver, scene, few);
  State state = scene.start, theirs = scene.start;
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(one->advance(state, 1e-3));
    ASSERT_TRUE(other->advance(theirs, 1e-3));
  }
  EXPECT_TRUE(state.x == alone.x && theirs.x == alone.x);
}

}  // namespace
}  // namespace engines
