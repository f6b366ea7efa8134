// What makes Newton's iteration cheap may not change what it converges to.
#include <gtest/gtest.h>

#include <cmath>

#include "solvers/registry.h"
#include "support/motion.h"

namespace inextensible {
namespace {

using testing::h;
using testing::Random;
using testing::random_mesh;
using testing::RandomMesh;
constexpr double strain_limit = 0.01, tolerance = 0.1;

std::unique_ptr<Stepper> springs(const RandomMesh& mesh, Settings settings) {
  settings["stiffness"] = 1e5;
  return make_stepper("implicit_springs", mesh.problem, {strain_limit, 1, settings});
}

const Settings plain_newton{{"start", std::string("flight")},
                            {"tension", std::string("current")},
                            {"reuse", 0.0},
                            {"newton_tolerance", 1e-7}};

// Gently enough that the energy has one minimum nearby: springs buckle neither way.
State gently_moving(Random& random, const RandomMesh& mesh, double speed = 0.5) {
  return testing::moving_state(random, mesh, speed);
}

// However Newton starts and whatever matrix it steps with, each step ends within the tolerance of
// where plain Newton, iterated until rounding, ends. Also where the history is of another motion.
TEST(ImplicitSprings, EndEveryStepAtTheMinimumThatPlainNewtonFinds) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    for (const char* start : {"flight", "extrapolated"}) {
      for (const char* tension : {"current", "linearized"}) {
        for (const double reuse : {0.0, 10.0, 100.0}) {
          SCOPED_TRACE("seed " + std::to_string(seed) + ' ' + start + ' ' + tension + ' ' +
                       std::to_string(reuse));
          Random random(seed);
          const RandomMesh mesh = random_mesh(random, 4, 4, 2);
          const auto plain = springs(mesh, plain_newton);
          const auto other = springs(mesh, {{"start", std::string(start)},
                                            {"tension", std::string(tension)},
                                            {"reuse", reuse},
                                            {"newton_tolerance", tolerance}});
          State elsewhere = gently_moving(random, mesh), state = gently_moving(random, mesh);
          ASSERT_TRUE(other->advance(elsewhere, 2 * h));
          for (int step = 0; step < 20; ++step) {
            State copy = state;
            ASSERT_TRUE(plain->advance(state, h));
            ASSERT_TRUE(other->advance(copy, h));
            EXPECT_LE((copy.x - state.x).colwise().norm().maxCoeff(),
                      tolerance * strain_limit * mesh.problem->shortest_rest_length())
                << "step " << step;
          }
        }
      }
    }
  }
}

WorkCounters work(const Settings& settings) {
  Random random(3);
  const RandomMesh mesh = random_mesh(random, 1, 30, 1);
  State state = gently_moving(random, mesh, 10);
  const auto stepper = springs(mesh, settings);
  for (int step = 0; step < 50; ++step) EXPECT_TRUE(stepper->advance(state, h));
  return stepper->work();
}

// Each of the three must do something, or the test above would hold for nothing.
TEST(ImplicitSprings, TakeFewerIterationsFromAPredictedStartAndTension) {
  const Settings none{
      {"start", std::string("flight")}, {"tension", std::string("current")}, {"reuse", 0.0}};
  Settings tension = none, start = none, reuse = none;
  tension["tension"] = std::string("linearized");
  start["start"] = std::string("extrapolated");
  reuse["reuse"] = 10.0;
  const WorkCounters before = work(none);
  EXPECT_EQ(before.factorizations, before.iterations);
  EXPECT_LT(work(tension).iterations, before.iterations);
  EXPECT_LT(work(start).iterations, before.iterations);
  EXPECT_LT(work(reuse).factorizations, before.factorizations);
}

// A refused step leaves the history alone too: what follows is the same to the last bit.
TEST(ImplicitSprings, StartAgainAfterARefusalAsIfItHadNotBeen) {
  Random random(5);
  const RandomMesh mesh = random_mesh(random, 4, 4, 2);
  State refused = gently_moving(random, mesh);
  State straight = refused;
  const auto first = springs(mesh, {});
  const auto second = springs(mesh, {});
  for (int step = 0; step < 10; ++step) {
    State wild = refused;
    wild.v *= 1e300;  // its energy overflows
    if (step > 0) {
      ASSERT_FALSE(first->advance(wild, h));
    }
    ASSERT_TRUE(first->advance(refused, h));
    ASSERT_TRUE(second->advance(straight, h));
    EXPECT_EQ(refused.x, straight.x) << "step " << step;
  }
}

}  // namespace
}  // namespace inextensible
