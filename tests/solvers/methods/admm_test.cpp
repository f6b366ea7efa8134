// What ADMM converges to, and that its matrix is factored once.

#include <gtest/gtest.h>

#include <cmath>

#include "support/side_by_side.h"

namespace inextensible {
namespace {

using testing::h;
using testing::Random;
using testing::random_mesh;
using testing::RandomMesh;

TEST(Admm, IteratedToTheEndIsTheClosestPoint) {
  testing::expect_closest_point("admm", {3.0, 10.0, 30.0}, 1e-8);
}

TEST(Admm, IsIcdOnTheGroundToo) {
  testing::expect_same_on_the_ground({"icd", {1e-9, 1, {}}}, {"admm", {1e-9, 1, {}}}, 1e-5);
}

// Inner forces come in equal and opposite pairs, which are parallel to their edges only in the end.
TEST(Admm, ConservesLinearMomentumAlwaysAndAngularWhereItHasConverged) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const RandomMesh mesh = random_mesh(random, 4, 5, 0);
    const Problem& problem = *mesh.problem;
    const State start = testing::moving_state(random, mesh, 4);
    const auto spin_lost = [&](double loosened) {
      const auto stepper =
          make_stepper("admm", mesh.problem, {0.005, 1, {{"direction_tolerance", loosened}}});
      State state = start;
      EXPECT_TRUE(stepper->advance(state, h));
      EXPECT_GT(stepper->work().iterations, 0);
      EXPECT_LT(testing::linear_momentum(problem, state.v - start.v).norm(), 1e-10);
      return testing::angular_momentum(problem, state.x, state.v - start.v).norm();
    };
    EXPECT_LT(spin_lost(1e-4), 0.01 * spin_lost(3));
  }
}

TEST(Admm, FactorsOnceWhateverTheSteps) {
  for (const char* solver : {"auto", "multifrontal", "cholmod_supernodal"}) {
    SCOPED_TRACE(solver);
    Random random(3);
    const RandomMesh mesh = random_mesh(random, 5, 6, 1);
    const auto plain = make_stepper("admm", mesh.problem, {1e-3, 1, {}}),
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
  ProblemParts parts;
  parts.gravity.setZero();
  parts.mass = {1, 3};
  parts.edges = {{0, 1}};
  parts.rest_length = {1};
  const auto problem = std::make_shared<const Problem>(parts);
  for (const auto& [from, to] : {std::pair{1.3, 1.05}, std::pair{0.8, 0.95}}) {
    const auto stepper = make_stepper("admm", problem, {0.1, 1, {{"target", 0.5}}});
    double length = 0;
    for (int i = 0; i < 300; ++i) {
      State state{Positions::Zero(3, 2), Positions::Zero(3, 2), 0};
      state.x(0, 1) = from;
      ASSERT_TRUE(stepper->advance(state, h));
      length = (state.x.col(1) - state.x.col(0)).norm();
      EXPECT_LE(std::abs(length - 1), 0.1);
    }
    EXPECT_NEAR(length, to, 1e-8);
  }
}

}  // namespace
}  // namespace inextensible
