// Chains whose motion is known: small oscillations of one that hangs, and one that hangs between
// two pins and stays.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/scenes/chain_scenes.h"
#include "solvers/registry.h"
#include "solvers/systems/constrained_acceleration.h"
#include "support/scenes.h"

namespace harness {
namespace {

using inextensible::State;
using testing::build;

// The zeros of L_2.
TEST(HangingFrequency, OfTheDoublePendulum) {
  EXPECT_NEAR(std::pow(hanging_frequency(2, 1, 1, 1), 2), 2 - std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(std::pow(hanging_frequency(2, 1, 1, 2), 2), 2 + std::sqrt(2.0), 1e-12);
}

// RATTLE, as any Stoermer-Verlet method, is fast by (omega h)^2 / 24.
TEST(HangingChain, OscillatesWithTheFrequenciesOfLaguerresZeros) {
  constexpr int masses = 10;
  constexpr double h = 1e-3;
  for (const int mode : {1, 2, 3}) {
    const Scene scene =
        build("hanging_chain",
              {{"n", masses + 1}, {"mode", static_cast<double>(mode)}, {"amplitude", 1e-4}});
    const double omega = hanging_frequency(masses, 0.1, 9.81, mode);
    State state = scene.start;
    const auto stepper = inextensible::make_stepper("rattle", scene.problem, {1e-13, 1, {}});
    // The free end's zero crossings, a quarter of a period after the start and then every half one.
    std::vector<double> crossings;
    while (crossings.size() < 11) {
      const double before = state.x(0, masses), time = state.time;
      ASSERT_TRUE(stepper->advance(state, h));
      const double after = state.x(0, masses);
      if (before * after < 0) crossings.push_back(time + h * before / (before - after));
      ASSERT_LT(state.time, 20);
    }
    const double found = M_PI * 10 / (crossings.back() - crossings.front());
    EXPECT_NEAR(found / omega, 1 + std::pow(omega * h, 2) / 24, 2e-6) << "mode " << mode;
  }
}

TEST(Catenary, OfLinksStaysWhereItHangs) {
  constexpr int links = 12;
  const Scene scene =
      build("catenary", {{"n", links + 1}, {"length", 1.2}, {"mass", links + 1}, {"slack", 1.5}});
  const State& start = scene.start;
  EXPECT_NEAR(start.x(0, links), 0.8, 1e-12);
  EXPECT_NEAR(start.x(1, links), 0, 1e-12);
  EXPECT_LT(inextensible::constrained_acceleration(*scene.problem, start).cwiseAbs().maxCoeff(),
            1e-9);
  const auto drift = [&](const char* solver, double h) {
    const auto stepper = inextensible::make_stepper(solver, scene.problem, {1e-11, 1, {}});
    State state = start;
    while (state.time < 1 - 0.5 * h)
      if (!stepper->advance(state, h)) return std::nan("");
    return (state.x - start.x).cwiseAbs().maxCoeff();
  };
  // Solutions of the step's equations stay; what the strain limit leaves of each fall adds up.
  for (const char* solver : {"shake", "rattle", "icd"})
    EXPECT_LT(drift(solver, 0.01), 1e-6) << solver;
  // Iterations that end elsewhere on the constraints shift the equilibrium, less by smaller steps.
  for (const char* solver : {"fast_projection", "fast_projection@bdf2", "gauss_seidel"}) {
    const double coarse = drift(solver, 0.01), fine = drift(solver, 0.0025);
    EXPECT_LT(coarse, 1e-3) << solver;
    EXPECT_LT(fine, coarse / 4) << solver << ": " << coarse << ", " << fine;
  }
}

}  // namespace
}  // namespace harness
