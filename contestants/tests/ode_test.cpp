#include "contestants/tests/known_scenes.h"

namespace engines {
namespace {

const std::string solver = "engine_ode";
const auto passes = [](double iterations) {
  return Settings{{"solver", std::string("passes")}, {"iterations", iterations}};
};

TEST(Ode, IsOfFirstOrder) { expect_first_order(solver); }
TEST(Ode, TakesAndGivesStates) { expect_free_flight(solver); }
TEST(Ode, TakesForces) { expect_spring(solver); }
TEST(Ode, RefusesWithoutTrace) { expect_overflow_refused(solver); }

// A chain that hangs at rest stays: the factorization finds its tensions, and few passes do not.
TEST(Ode, HangsAtRest) {
  const Scene scene = hanging_chain(10);
  EXPECT_LT(distance(run(solver, scene, 0.01, 100).x, scene.start.x), 1e-9);
  EXPECT_GT(largest_strain(scene, run(solver, scene, 0.01, 1, passes(1))), 1e-4);
  EXPECT_LT(distance(run(solver, scene, 0.01, 1, passes(200)).x, scene.start.x), 1e-6);
}

// Where both find the same multipliers they move the same. Nothing is damped: what a corrected
// step loses vanishes with the step, as does the strain.
TEST(Ode, PassesConvergeToTheFactorization) {
  const Scene scene = swirling_chain(5);
  const State direct = run(solver, scene, 1e-3, 100);
  EXPECT_LT(distance(direct.x, run(solver, scene, 1e-3, 100, passes(200)).x), 1e-6);
  EXPECT_LT(largest_strain(scene, direct), 1e-3);
  const State finer = run(solver, scene, 5e-4, 200);
  EXPECT_LT(largest_strain(scene, finer), 0.6 * largest_strain(scene, direct));
  EXPECT_NEAR(angular_momentum(scene, finer).y(), angular_momentum(scene, scene.start).y(), 1e-2);
}

// Forces and corrections of drift along directions at the start of a step keep angular momentum.
TEST(Ode, NetKeepsSpinning) {
  const Scene scene = spinning_net(4, 2 * std::numbers::pi);
  const State end = run(solver, scene, 1e-3, 500);
  EXPECT_NEAR(angular_momentum(scene, end).y() / angular_momentum(scene, scene.start).y(), 1, 1e-9);
  EXPECT_LT(largest_strain(scene, end), 1e-3);
}

// Another stepper's random numbers are not taken.
TEST(Ode, SteppersDoNotDisturbEachOther) {
  const Scene scene = swirling_chain(5);
  const State alone = run(solver, scene, 1e-3, 40, passes(2));
  const auto one = make(solver, scene, passes(2)), other = make(solver, scene, passes(2));
  State state = scene.start, theirs = scene.start;
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(one->advance(state, 1e-3));
    ASSERT_TRUE(other->advance(theirs, 1e-3));
  }
  EXPECT_TRUE(state.x == alone.x && theirs.x == alone.x);
}

}  // namespace
}  // namespace engines
