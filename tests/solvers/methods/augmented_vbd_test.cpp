// What the method of multipliers converges to, and what it remembers.
#include "solvers/methods/augmented_vbd.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solvers/registry.h"
#include "support/contact.h"
#include "support/motion.h"

namespace inextensible {
namespace {

using testing::Random;
using testing::random_mesh;
using testing::RandomMesh;

// Theorem 1 of Goldenthal et al. 2007, by the dense Newton of the oracle, whatever the penalty.
TEST(AugmentedVbd, IteratedToTheEndIsTheClosestPoint) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    for (const double penalty : {1.0, 10.0, 50.0}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", penalty " + std::to_string(penalty));
      Random random(seed);
      const RandomMesh mesh = random_mesh(random, 4, 4, static_cast<int>(seed % 2));
      const auto oracle = make_stepper("oracle", mesh.problem, {1e-10, 1, {}});
      const auto augmented =
          make_stepper("augmented_vbd", mesh.problem, {1e-10, 1, {{"penalty", penalty}}});
      State state = testing::moving_state(random, mesh, 1);
      for (int step = 0; step < 5; ++step) {
        State copy = state;
        ASSERT_TRUE(oracle->advance(state, testing::h));
        ASSERT_TRUE(augmented->advance(copy, testing::h));
        EXPECT_LE((copy.x - state.x).cwiseAbs().maxCoeff(), 1e-7) << "step " << step;
      }
    }
  }
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
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto ground =
        std::make_shared<const testing::Ground>(Eigen::Vector3d(0.1, 1, 0), 0.0, 0.2);
    const RandomMesh mesh = random_mesh(random, 4, 4, 0, ground);
    const auto icd = make_stepper("icd", mesh.problem, {1e-9, 1, {}});
    const auto augmented = make_stepper("augmented_vbd", mesh.problem, {1e-9, 1, {}});
    State state = testing::moving_state(random, mesh, 0.3);
    state.x.row(1).array() += 0.5;
    state.v.row(1).array() -= 3;
    State other = state;
    for (int step = 0; step < 30; ++step) {
      ASSERT_TRUE(icd->advance(state, testing::h));
      ASSERT_TRUE(augmented->advance(other, testing::h));
      ASSERT_LE((other.x - state.x).cwiseAbs().maxCoeff(), 1e-5) << "step " << step;
    }
    EXPECT_GT(augmented->work().contacts, 0);
  }
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

}  // namespace
}  // namespace inextensible
