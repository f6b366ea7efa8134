// A solver beside another one that it must agree with.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>

#include "solvers/registry.h"
#include "support/contact.h"
#include "support/motion.h"

namespace inextensible::testing {

struct Contender {
  const char* solver;
  BackendOptions options;
};

// Theorem 1 of Goldenthal et al. 2007, by dense Newton, whatever the penalty.
inline void expect_closest_point(const char* solver, std::initializer_list<double> penalties,
                                 double tolerance) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    for (const double penalty : penalties) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", penalty " + std::to_string(penalty));
      Random random(seed);
      const RandomMesh mesh = random_mesh(random, 4, 4, static_cast<int>(seed % 2));
      const auto oracle = make_stepper("dense_newton", mesh.problem, {1e-10, 1, {}});
      const auto examined = make_stepper(solver, mesh.problem, {1e-10, 1, {{"penalty", penalty}}});
      State state = moving_state(random, mesh, 1);
      for (int step = 0; step < 5; ++step) {
        State copy = state;
        ASSERT_TRUE(oracle->advance(state, h));
        ASSERT_TRUE(examined->advance(copy, h));
        EXPECT_LE((copy.x - state.x).cwiseAbs().maxCoeff(), tolerance) << "step " << step;
      }
    }
  }
}

// Both fall onto a ground that slopes, with friction.
inline void expect_same_on_the_ground(const Contender& known, const Contender& examined,
                                      double tolerance) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto ground = std::make_shared<const Ground>(Eigen::Vector3d(0.1, 1, 0), 0.0, 0.2);
    const RandomMesh mesh = random_mesh(random, 4, 4, 0, ground);
    const auto one = make_stepper(known.solver, mesh.problem, known.options),
               other = make_stepper(examined.solver, mesh.problem, examined.options);
    State state = moving_state(random, mesh, 0.3);
    state.x.row(1).array() += 0.5;
    state.v.row(1).array() -= 3;
    State copy = state;
    for (int step = 0; step < 30; ++step) {
      ASSERT_TRUE(one->advance(state, h));
      ASSERT_TRUE(other->advance(copy, h));
      ASSERT_LE((copy.x - state.x).cwiseAbs().maxCoeff(), tolerance) << "step " << step;
    }
    EXPECT_GT(other->work().contacts, 0);
  }
}

}  // namespace inextensible::testing
