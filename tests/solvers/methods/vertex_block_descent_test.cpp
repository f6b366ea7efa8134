// Passes against an obvious one, and what they converge to: the minimum that Newton finds.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "solvers/methods/vertex_passes.h"
#include "support/side_by_side.h"

namespace inextensible {
namespace {

using testing::h;
using testing::linear_momentum;
using testing::Random;
using testing::random_mesh;
using testing::RandomMesh;

// The step of Chen et al. 2024 for one vertex: x += H^-1 f.
void move(int v, const Problem& problem, const Springs& springs, const Positions& y, Positions& x) {
  const double m = problem.mass()[v];
  Eigen::Vector3d f = m * (y.col(v) - x.col(v));
  Eigen::Matrix3d hessian = m * Eigen::Matrix3d::Identity();
  for (std::size_t k = 0; k < springs.edges.size(); ++k) {
    const auto [a, b] = springs.edges[k];
    if (a != v && b != v) continue;
    const Eigen::Vector3d d = x.col(a == v ? b : a) - x.col(v), n = d.normalized();
    const double stiffness = springs.stiffness[k], rest = springs.rest_length[k];
    f += stiffness * (d.norm() - rest) * n;
    const Eigen::Matrix3d along = n * n.transpose();
    hessian += stiffness *
               (along + std::max(0.0, 1 - rest / d.norm()) * (Eigen::Matrix3d::Identity() - along));
  }
  x.col(v) += hessian.llt().solve(f);
}

// A row of n vertices has the even ones first, then the odd ones.
TEST(VertexPasses, MoveOneVertexAfterTheOtherInColors) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const int n = 2 + static_cast<int>(random() % 40);
    const RandomMesh row = random_mesh(random, 1, n, static_cast<int>(seed % 2));
    const Problem& problem = *row.problem;
    const int first = problem.pinned().empty() ? 0 : problem.pinned()[0];
    Springs springs{problem.edges(), problem.rest_length(), {}};
    for (int k = 0; k < problem.constraints(); ++k)
      springs.stiffness.push_back(testing::uniform(random, 0, 100));
    const Positions y = testing::perturbed(random, row, 0.2);
    Positions x = testing::perturbed(random, row, 0.2), wanted = x;
    VertexPasses passes(problem, springs);
    passes.load(x, y, problem.mass());
    for (int i = 0; i < 3; ++i) {
      passes.visit_all(1);
      // Colors alternate from each end of the row, and start again behind a pin.
      for (const int color : {0, 1}) {
        for (int v = 0; v < n; ++v) {
          const bool pinned = !problem.pinned().empty() && v == first;
          const int place = problem.pinned().empty() || v < first ? v : v - first - 1;
          if (!pinned && place % 2 == color) move(v, problem, springs, y, wanted);
        }
      }
    }
    passes.store(x);
    EXPECT_LT((x - wanted).cwiseAbs().maxCoeff(), 1e-12);
  }
}

// The mesh under gravity, with shear springs and drag.
std::shared_ptr<const Problem> furnished(const RandomMesh& mesh, bool shear, bool drag) {
  const Problem& bare = *mesh.problem;
  ProblemParts parts;
  parts.mass = bare.mass();
  parts.pinned = bare.pinned();
  parts.edges = bare.edges();
  parts.rest_length = bare.rest_length();
  if (shear) {
    parts.shear = Springs{{{0, 5}, {1, 4}, {5, 10}}, {1.2, 1.3, 1.4}, {30, 20, 50}};
  }
  if (drag) parts.drag.assign(parts.mass.size(), 0.7);
  return std::make_shared<const Problem>(std::move(parts));
}

TEST(VertexBlockDescent, ConvergesToTheStepOfImplicitSprings) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const RandomMesh mesh = random_mesh(random, 4, 4, static_cast<int>(seed % 3));
    const auto problem = furnished(mesh, seed % 2 == 0, seed % 4 < 2);
    const auto newton = make_stepper("implicit_springs", problem, {1e-6, 1, {}});
    const auto descent =
        make_stepper("vertex_block_descent", problem, {0.01, 1, {{"iterations", 2000.0}}});
    State state = testing::moving_state(random, mesh, 0.5);
    for (int step = 0; step < 10; ++step) {
      State copy = state;
      ASSERT_TRUE(newton->advance(state, h));
      ASSERT_TRUE(descent->advance(copy, h));
      EXPECT_LE((copy.x - state.x).cwiseAbs().maxCoeff(), 1e-8) << "step " << step;
    }
  }
}

// Where vertices stand on a floor as well: the minimum within its half-space.
TEST(VertexBlockDescent, ConvergesToTheSameOnTheGround) {
  testing::expect_same_on_the_ground({"implicit_springs", {1e-6, 1, {}}},
                                     {"vertex_block_descent", {0.01, 1, {{"iterations", 2000.0}}}},
                                     1e-6);
}

// Each vertex moves alone: a pass gives momentum away, and convergence brings it back.
TEST(VertexBlockDescent, ConservesMomentumAsFarAsItHasConverged) {
  Random random(1);
  const RandomMesh mesh = random_mesh(random, 5, 5, 0);
  const State start = testing::moving_state(random, mesh, 4);
  const auto lost = [&](double iterations) {
    const auto stepper =
        make_stepper("vertex_block_descent", mesh.problem, {0.01, 1, {{"iterations", iterations}}});
    State state = start;
    EXPECT_TRUE(stepper->advance(state, h));
    EXPECT_EQ(stepper->work().iterations, iterations);
    return (linear_momentum(*mesh.problem, state.v - start.v)).norm();
  };
  EXPECT_GT(lost(2), 1e-3);
  EXPECT_LT(lost(20), 0.1 * lost(2));
  EXPECT_LT(lost(2000), 1e-9);
}

// The first step starts from the free flight, later ones from as much of gravity as the last step
// let through: a rope at rest from where it is, so that one pass leaves it there.
TEST(VertexBlockDescent, StartsWhereTheLastStepSaysThatItWillEnd) {
  ProblemParts parts;
  constexpr int links = 10;
  constexpr double stiffness = 1e4, mass = 0.1, length = 0.1;
  parts.mass.assign(links + 1, mass);
  parts.pinned = {0};
  Positions x = Positions::Zero(3, links + 1);
  for (int i = 0; i < links; ++i) {
    parts.edges.push_back({i, i + 1});
    parts.rest_length.push_back(length);
    // Static: each link bears what hangs on it.
    x(1, i + 1) = x(1, i) - length * (1 + (links - i) * mass * 9.81 / stiffness);
  }
  const auto problem = std::make_shared<const Problem>(parts);
  for (const double iterations : {1.0, 5.0}) {
    const auto stepper =
        make_stepper("vertex_block_descent", problem,
                     {0.01, 1, {{"stiffness", stiffness}, {"iterations", iterations}}});
    State state{x, Positions::Zero(3, links + 1), 0};
    ASSERT_TRUE(stepper->advance(state, h));
    EXPECT_GT((state.x - x).cwiseAbs().maxCoeff(), 1e-6);
    state = {x, Positions::Zero(3, links + 1), h};  // at rest, a step later
    ASSERT_TRUE(stepper->advance(state, h));
    EXPECT_LT((state.x - x).cwiseAbs().maxCoeff(), 1e-12);
  }
}

}  // namespace
}  // namespace inextensible
