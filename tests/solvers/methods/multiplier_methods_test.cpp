// ADMM and augmented VBD: what they converge to, and what they remember.
#include <gtest/gtest.h>

#include <cmath>

#include "solvers/problem/edge_constraints.h"
#include "solvers/registry.h"
#include "support/motion.h"

namespace inextensible {
namespace {

using testing::h;
using testing::Random;
using testing::random_mesh;
using testing::RandomMesh;

TEST(Admm, FactorsOnceWhateverTheSteps) {
  for (const char* solver : {"auto", "multifrontal", "cholmod_supernodal"}) {
    SCOPED_TRACE(solver);
    Random random(3);
    const RandomMesh mesh = random_mesh(random, 5, 6, 1);
    const auto plain = make_stepper("admm", mesh.problem, {1e-3}),
               other = make_stepper("admm", mesh.problem,
                                    {1e-3, 1, {{"linear_solver", std::string(solver)}}});
    State state = testing::moving_state(random, mesh, 2), copy = state;
    for (const double step : {h, h / 2, h, h / 4}) {
      ASSERT_TRUE(plain->advance(state, step));
      ASSERT_TRUE(other->advance(copy, step));
    }
    EXPECT_EQ(other->work().factorizations, 1);
    EXPECT_EQ(other->work().back_solves, 3 * other->work().iterations);
    EXPECT_LT((copy.x - state.x).norm(), 1e-10);
  }
}

// A step ends within the limit; the same step again goes on from its forces, and so they end where
// an edge is strained by `target` times the limit.
TEST(Admm, BringsAnEdgeToItsTarget) {
  for (const auto& [from, to] : {std::pair{1.3, 1.05}, std::pair{0.8, 0.95}}) {
    const auto stepper = make_stepper("admm", testing::one_edge(1, 3), {0.1, 1, {{"target", 0.5}}});
    double length = 0;
    for (int i = 0; i < 300; ++i) {
      State state = testing::stretched_edge(from);
      ASSERT_TRUE(stepper->advance(state, h));
      length = (state.x.col(1) - state.x.col(0)).norm();
      EXPECT_LE(std::abs(length - 1), 0.1);
    }
    EXPECT_NEAR(length, to, 1e-8);
  }
}

// Multiplier k of a rope at rest is the weight that hangs on link k, and once it is known a step
// takes a fraction of the passes, also where the step changes. A refused step is forgotten.
TEST(AugmentedVbd, KeepsTheMultipliersOfTheLastAcceptedStep) {
  const testing::HangingRope rope(40, 0.1, 0.1);
  const auto stepper = make_stepper("augmented_vbd", rope.problem, {1e-8});
  State state = rope.start;
  const StepResult first = stepper->advance(state, h);
  ASSERT_TRUE(first);
  for (const double step : {h, 2 * h, h / 2}) {
    State wild = rope.start;
    wild.v = 1e300 * Positions::Random(3, 41);
    EXPECT_FALSE(stepper->advance(wild, step));
    state = rope.start;
    const StepResult next = stepper->advance(state, step);
    ASSERT_TRUE(next);
    EXPECT_LT(5 * next.iterations, first.iterations);
    EXPECT_LT((state.x - rope.start.x).cwiseAbs().maxCoeff(), 1e-6);
  }
}

// The pin of a hanging rope jumps by two links: with the forces of the step before, passes
// overflow.
TEST(AugmentedVbd, BeginsAgainWhereTheLastForcesOverflow) {
  const testing::HangingRope rope(20, 0.05, 0.05);
  const auto warm = make_stepper("augmented_vbd", rope.problem, {0.01}),
             cold = make_stepper("augmented_vbd", rope.problem, {0.01});
  State turning = rope.start;  // at 200 rad/s: forces of a thousand times the weight
  for (int i = 0; i <= 20; ++i) turning.v(0, i) = 200 * 0.05 * i;
  for (int step = 0; step < 5; ++step) ASSERT_TRUE(warm->advance(turning, 0.001));
  State state = rope.start;
  state.x(0, 0) += 0.1;
  State fresh = state;
  const StepResult again = warm->advance(state, h), once = cold->advance(fresh, h);
  ASSERT_TRUE(again && once);
  EXPECT_GT(again.iterations, 64 + once.iterations);  // passes look for overflow every 64
  EXPECT_EQ(state.x, fresh.x);
  EXPECT_TRUE(EdgeConstraints(*rope.problem, 0.01).permissible(state.x));
}

}  // namespace
}  // namespace inextensible
