// Methods that solve the same equations by different iterations: they take the same steps, and keep
// the same momentum, as far as they have converged.
#include <gtest/gtest.h>

#include "harness/judge/mechanics.h"
#include "solvers/registry.h"
#include "support/contact.h"
#include "support/motion.h"

namespace inextensible {
namespace {

using testing::for_seeds;
using testing::h;
using testing::Random;

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

// ADMM's inner forces come in equal and opposite pairs, which are parallel to their edges only in
// the end. Descent moves each vertex alone: even linear momentum is kept only as far as the
// iteration has converged.
TEST(Agreement, MomentumIsKeptAsFarAsAMethodHasConverged) {
  const struct {
    const char *solver, *setting;
    double loose, close, converged;
    bool linear_anyway;  // linear momentum
  } cases[] = {{"admm", "direction_tolerance", 3, 1e-4, 1e-8, true},
               {"augmented_vbd", "direction_tolerance", 3, 1e-4, 1e-8, false},
               {"vertex_block_descent", "iterations", 2, 40, 2000, false}};
  for (const auto& each : cases) {
    SCOPED_TRACE(each.solver);
    for_seeds(4, [&](Random& random, std::uint64_t) {
      const auto mesh = testing::random_mesh(random, 4, 5, 0);
      const State start = testing::moving_state(random, mesh, 4);
      const auto lost = [&](double value) {
        State state = start;
        EXPECT_TRUE(make_stepper(each.solver, mesh.problem, {0.005, 1, {{each.setting, value}}})
                        ->advance(state, h));
        state.v -= start.v;  // what the step has given
        const double linear = harness::linear_momentum(*mesh.problem, state.v).norm();
        if (!each.linear_anyway) return linear;
        EXPECT_LT(linear, 1e-10);
        return harness::angular_momentum(*mesh.problem, state).norm();
      };
      EXPECT_LT(lost(each.close), 0.01 * lost(each.loose));
      EXPECT_LT(lost(each.converged), 1e-7);
    });
  }
}

}  // namespace
}  // namespace inextensible
