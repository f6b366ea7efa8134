// Exact invariants of whole runs at the scenes' own sizes: energy of the chain, mirror symmetry of
// the drape up to its first contact, and the pendulum's order with its errors.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/judge/mechanics.h"
#include "harness/scenes/scene.h"
#include "solvers/problem/forces.h"
#include "solvers/problem/triangle_collider.h"
#include "solvers/registry.h"
#include "support/scenes.h"

namespace harness {
namespace {

using inextensible::State;
using testing::build;

// Largest rise of the total energy above its start, over weight times length.
double energy_rise(const char* solver, double limit, double h,
                   const inextensible::Settings& settings) {
  const Scene chain = build("chain", {});
  State state = chain.start;
  const auto stepper = inextensible::make_stepper(solver, chain.problem, {limit, 1, settings});
  const auto energy = [&] {
    return inextensible::potential_energy(*chain.problem, state.x) +
           inextensible::kinetic_energy(*chain.problem, state.v);
  };
  const double before = energy();
  double rise = 0;
  for (int i = 0; i * h < 1; ++i) {
    if (!stepper->advance(state, h)) return std::nan("");
    rise = std::max(rise, energy() - before);
  }
  return rise / 9.81;
}

// Backward Euler's and the end-of-step direction's dissipation outweighs what is left of strain.
TEST(Energy, OfTheEightyVertexChainNeverRisesUnderImplicitMethods) {
  EXPECT_LE(energy_rise("icd", 1e-6, 0.005, {}), 1e-9);
  EXPECT_LE(energy_rise("fast_projection", 1e-6, 0.005, {}), 1e-9);
  EXPECT_LE(energy_rise("implicit_springs", 1e-6, 0.005, {{"stiffness", 1e5}}), 1e-9);
}

// With contact inside, cloth is what was promised after the collision filter, too: within the limit
// and outside the ball; and friction and collision only take energy.
TEST(Drape, IsDeliveredWithinTheLimitAndOutsideTheBallByEveryMethod) {
  constexpr double limit = 0.01, h = 0.005, invisible = 1e-6;
  const Scene drape = build("drape", {{"n", 11}});
  const auto& ball =
      dynamic_cast<const inextensible::TriangleCollider&>(*drape.problem->collider());
  const double scale = energy_scale(drape), before = total_energy(*drape.problem, drape.start);
  for (const inextensible::Backend& backend : inextensible::backends()) {
    if (!backend.contestant || backend.strain_control != inextensible::StrainControl::strain_limit)
      continue;
    SCOPED_TRACE(backend.name);
    const auto stepper = inextensible::make_stepper(backend.name, drape.problem, {limit, 1, {}});
    State state = drape.start;
    for (int step = 0; step < 40; ++step) {
      const auto result = stepper->advance(state, h);
      ASSERT_TRUE(result) << "step " << step << ": " << result.detail;
      EXPECT_LE(strain_range(*drape.problem, state.x).most, limit * (1 + 1e-9)) << "step " << step;
      EXPECT_LE(total_energy(*drape.problem, state) - before, 0.05 * scale) << "step " << step;
      for (Eigen::Index v = 0; v < state.x.cols(); ++v)
        ASSERT_GE(ball.nearest(state.x.col(v)).signed_distance, -invisible) << "vertex " << v;
    }
    EXPECT_GT(stepper->work().contacts, 0);
  }
}

TEST(Drape, OfFullSizeKeepsItsMirrorSymmetryUntilFirstContact) {
  for (const char* solver : {"fast_projection", "icd", "jacobi"}) {
    SCOPED_TRACE(solver);
    const Scene drape = build("drape", {{"gap", 0.05}, {"contact", 0}});
    State state = drape.start;
    // Bends and stretches it, symmetrically in both planes.
    state.v.row(1) =
        (2 * state.x.row(0).array().square() - state.x.row(2).array().square()).matrix();
    inextensible::BackendOptions options{0.001, 1, {}};
    // The defaults of both factor in single precision.
    if (solver == std::string("fast_projection"))
      options.settings["linear_solver"] = std::string("multifrontal");
    if (solver == std::string("icd"))
      options.settings["linear_solver"] = std::string("quasi_definite");
    const auto stepper = inextensible::make_stepper(solver, drape.problem, options);
    int steps = 0;
    while (steps < 8) {
      ASSERT_TRUE(stepper->advance(state, 0.01));
      if (stepper->work().contacts > 0) break;
      ++steps;
      for (const auto& mirror : drape.mirrors) {
        double defect = 0;
        for (Eigen::Index v = 0; v < state.x.cols(); ++v) {
          const Eigen::Vector3d reflected =
              state.x.col(v) - 2 * mirror.normal.dot(state.x.col(v)) * mirror.normal;
          defect = std::max(defect, (reflected - state.x.col(mirror.image[v])).norm());
        }
        EXPECT_LT(defect, 1e-9) << "step " << steps;
      }
    }
    EXPECT_GE(steps, 4) << "too few steps before contact to mean anything";
    EXPECT_GT(stepper->work().iterations, 0) << "nothing was stretched, nothing tested";
  }
}

}  // namespace
}  // namespace harness
