// Methods that solve the same equations by different iterations take the same steps.
#include "harness/judge/mechanics.h"
#include "solvers/problem/edge_constraints.h"
#include "support/motion.h"

namespace inextensible {
namespace {

using testing::for_seeds, testing::h, testing::Random;

enum class Under { nothing, forces, contact };  // forces: shear, bending and drag of some vertices

// Theorem 1 of Goldenthal et al. 2007, by dense Newton, whatever the penalty; and backward Euler's
// step with springs. In contact they fall onto a ground that slopes, with friction.
TEST(Agreement, MethodsOfTheSameEquationsTakeTheSameSteps) {
  const BackendOptions exact{1e-10}, tight{1e-9}, soft{1e-6},
      descent{0.01, 1, {{"iterations", 2000.0}}};
  const auto penalty = [](double value) { return BackendOptions{1e-10, 1, {{"penalty", value}}}; };
  const struct {
    const char *known, *examined;
    BackendOptions known_options, options;
    Under under;
    double speed, tolerance;
  } pairs[] = {
      {"dense_newton", "admm", exact, penalty(3), Under::nothing, 1, 1e-7},
      {"dense_newton", "admm", exact, penalty(30), Under::nothing, 1, 1e-7},
      {"dense_newton", "augmented_vbd", exact, penalty(3), Under::nothing, 1, 1e-7},
      {"dense_newton", "augmented_vbd", exact, penalty(30), Under::nothing, 1, 1e-7},
      {"icd", "admm", tight, tight, Under::contact, 0.3, 1e-5},
      {"icd", "augmented_vbd", tight, tight, Under::contact, 0.3, 1e-5},
      {"implicit_springs", "vertex_block_descent", soft, descent, Under::forces, 0.5, 1e-8},
      {"implicit_springs", "vertex_block_descent", soft, descent, Under::contact, 0.3, 1e-6}};
  for (const auto& pair : pairs) {
    SCOPED_TRACE(std::string(pair.examined) + " and " + pair.known);
    for_seeds(pair.under == Under::contact ? 4 : 6, [&](Random& random, std::uint64_t seed) {
      const bool contact = pair.under == Under::contact;
      const auto mesh =
          testing::random_mesh(random, 4, 4, contact ? 0 : static_cast<int>(seed % 3));
      ProblemParts parts = testing::parts_of(*mesh.problem);
      if (contact)
        parts.collider =
            std::make_shared<const testing::Ground>(Eigen::Vector3d(0.1, 1, 0), 0.0, 0.2);
      if (pair.under == Under::forces) {
        parts.gravity = {0, -9.81, 0};
        if (seed % 2 == 0)
          parts.shear = Springs{{{0, 5}, {1, 4}, {5, 10}}, {1.2, 1.3, 1.4}, {30, 20, 50}};
        if (seed % 4 < 2) parts.drag.assign(parts.mass.size(), 0.7);
        if (seed % 3 < 2)
          parts.bending = {yarn_bending(0, 1, 2, 1, 1.1, 4), yarn_bending(1, 5, 9, 0.9, 1, 30),
                           yarn_bending(4, 5, 6, 1, 1, 9)};
      }
      const auto problem = std::make_shared<const Problem>(std::move(parts));
      const auto one = make_stepper(pair.known, problem, pair.known_options),
                 other = make_stepper(pair.examined, problem, pair.options);
      State state = testing::moving_state(random, mesh, pair.speed);
      if (contact) {
        state.x.row(1).array() += 0.5;
        state.v.row(1).array() -= 3;
      }
      for (int step = 0; step < (contact ? 30 : 10); ++step) {
        State copy = state;
        ASSERT_TRUE(one->advance(state, h));
        ASSERT_TRUE(other->advance(copy, h));
        ASSERT_LE((copy.x - state.x).cwiseAbs().maxCoeff(), pair.tolerance) << "step " << step;
      }
      EXPECT_EQ(other->work().contacts > 0, contact);
    });
  }
}

// Its inner forces come in equal and opposite pairs. They are parallel to their edges, and keep
// angular momentum, only in the end.
TEST(Admm, KeepsLinearMomentumHoweverEarlyItStops) {
  for_seeds(4, [&](Random& random, std::uint64_t) {
    const auto mesh = testing::random_mesh(random, 4, 5, 0);
    const State start = testing::moving_state(random, mesh, 4);
    const auto given = [&](double tolerance) {  // linear and angular momentum
      State state = start;
      EXPECT_TRUE(
          make_stepper("admm", mesh.problem, {0.005, 1, {{"direction_tolerance", tolerance}}})
              ->advance(state, h));
      state.v -= start.v;
      return std::pair(harness::linear_momentum(*mesh.problem, state.v).norm(),
                       harness::angular_momentum(*mesh.problem, state).norm());
    };
    const auto [linear, angular] = given(3);
    EXPECT_LT(linear, 1e-10);
    EXPECT_LT(given(1e-4).second, 0.01 * angular);
  });
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

// The pin of a hanging rope jumps by two links: with the last step's forces, passes overflow.
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
