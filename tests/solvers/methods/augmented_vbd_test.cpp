// What the method of multipliers converges to, and what it remembers.

#include <gtest/gtest.h>

#include <cmath>

#include "solvers/problem/edge_constraints.h"
#include "support/side_by_side.h"

namespace inextensible {
namespace {

using testing::Random;
using testing::random_mesh;
using testing::RandomMesh;

TEST(AugmentedVbd, IteratedToTheEndIsTheClosestPoint) {
  testing::expect_closest_point("augmented_vbd", {1.0, 10.0, 50.0}, 1e-7);
}

// Each vertex moves alone: what momentum a step takes or gives falls with its tolerance.
TEST(AugmentedVbd, ConservesMomentumAsFarAsItHasConverged) {
  Random random(1);
  const RandomMesh mesh = random_mesh(random, 5, 5, 0);
  const State start = testing::moving_state(random, mesh, 4);
  const auto lost = [&](double tolerance) {
    const auto stepper = make_stepper("augmented_vbd", mesh.problem,
                                      {0.005, 1, {{"direction_tolerance", tolerance}}});
    State state = start;
    EXPECT_TRUE(stepper->advance(state, testing::h));
    return testing::linear_momentum(*mesh.problem, state.v - start.v).norm();
  };
  EXPECT_GT(lost(3), 1e-4);
  EXPECT_LT(lost(1e-3), 0.01 * lost(3));
  EXPECT_LT(lost(1e-8), 1e-8);
}

TEST(AugmentedVbd, IsIcdOnTheGroundToo) {
  testing::expect_same_on_the_ground({"icd", {1e-9, 1, {}}}, {"augmented_vbd", {1e-9, 1, {}}},
                                     1e-5);
}

// A rope at rest: multiplier k is the weight that hangs on link k, and once it is known a step
// takes a fraction of the passes, also where the step changes. A refused step is forgotten.
TEST(AugmentedVbd, KeepsTheMultipliersOfTheLastAcceptedStep) {
  ProblemParts parts;
  constexpr int links = 40;
  parts.mass.assign(links + 1, 0.1);
  parts.pinned = {0};
  Positions x = Positions::Zero(3, links + 1);
  for (int i = 0; i < links; ++i) {
    parts.edges.push_back({i, i + 1});
    parts.rest_length.push_back(0.1);
    x(1, i + 1) = -0.1 * (i + 1);
  }
  const auto problem = std::make_shared<const Problem>(parts);
  const State rest{x, Positions::Zero(3, links + 1), 0};
  const auto stepper = make_stepper("augmented_vbd", problem, {1e-8, 1, {}});
  State state = rest;
  const StepResult first = stepper->advance(state, testing::h);
  ASSERT_TRUE(first);
  for (const double step : {testing::h, 2 * testing::h, testing::h / 2}) {
    state = rest;
    State wild = rest;
    wild.v = 1e300 * Positions::Random(3, links + 1);
    EXPECT_FALSE(stepper->advance(wild, step));
    const StepResult next = stepper->advance(state, step);
    ASSERT_TRUE(next);
    EXPECT_LT(5 * next.iterations, first.iterations);
    EXPECT_LT((state.x - x).cwiseAbs().maxCoeff(), 1e-6);
  }
}

// The pin of a hanging rope jumps by ten links: with the forces of the step before, passes
// overflow.
TEST(AugmentedVbd, BeginsAnewWhereTheLastForcesOverflow) {
  ProblemParts parts;
  constexpr int links = 20;
  parts.mass.assign(links + 1, 0.05);
  parts.pinned = {0};
  State state{Positions::Zero(3, links + 1), Positions::Zero(3, links + 1), 0};
  for (int i = 0; i < links; ++i) {
    parts.edges.push_back({i, i + 1});
    parts.rest_length.push_back(0.05);
    state.x(1, i + 1) = -0.05 * (i + 1);
  }
  const auto problem = std::make_shared<const Problem>(parts);
  const auto warm = make_stepper("augmented_vbd", problem, {0.01, 1, {}}),
             cold = make_stepper("augmented_vbd", problem, {0.01, 1, {}});
  State turning = state;  // at 200 rad/s: forces of a thousand times the weight
  for (int i = 0; i <= links; ++i) turning.v(0, i) = 200 * 0.05 * i;
  for (int step = 0; step < 5; ++step) ASSERT_TRUE(warm->advance(turning, 0.001));
  state.x(0, 0) += 0.1;
  State fresh = state;
  const StepResult again = warm->advance(state, 0.01), once = cold->advance(fresh, 0.01);
  ASSERT_TRUE(again);
  ASSERT_TRUE(once);
  EXPECT_GT(again.iterations, 64 + once.iterations);  // passes look for overflow every 64
  EXPECT_EQ(state.x, fresh.x);
  EXPECT_TRUE(EdgeConstraints(*problem, 0.01).permissible(state.x));
}

}  // namespace
}  // namespace inextensible
