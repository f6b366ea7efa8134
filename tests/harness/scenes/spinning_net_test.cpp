// The spinning net, whose motion is known: what each kind of method makes of it follows from
// theory, to the last digits.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "harness/scenes/scene.h"
#include "solvers/registry.h"

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::State;

constexpr double turn = 2 * std::numbers::pi;  // rad/s at the start

// The angle by which a net in its plane has turned from x to y, rad.
double angle_between(const Positions& x, const Positions& y) {
  double cosine = 0, sine = 0;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    cosine += x(0, i) * y(0, i) + x(2, i) * y(2, i);
    sine += x(2, i) * y(0, i) - x(0, i) * y(2, i);
  }
  return std::atan2(sine, cosine);
}

// The angle of each step up to one second, from velocities of the start itself.
std::vector<double> step_angles(const char* solver, double h) {
  const Scene scene = built_scene("spinning_net", {{"n", 6}});
  const auto stepper = inextensible::make_stepper(solver, scene.problem, {1e-11});
  State state = scene.start;
  std::vector<double> angles;
  for (int i = 0; (i + 0.5) * h < 1; ++i) {
    const Positions before = state.x;
    EXPECT_TRUE(stepper->advance(state, h)) << solver << ", step " << i;
    angles.push_back(angle_between(before, state.x));
  }
  return angles;
}

// Free flight x + (x - x_before), brought back along directions at the end of the step:
// tan(next angle) = sin(angle) / (2 - cos(angle)).
TEST(SpinningNet, LosesSpeedByAnExactLawWhereDirectionsAreOfTheEndOfTheStep) {
  for (const char* solver : {"fast_projection", "icd"}) {
    for (const double h : {0.01, 0.0025}) {
      SCOPED_TRACE(std::string(solver) + ", h = " + std::to_string(h));
      const std::vector<double> angles = step_angles(solver, h);
      EXPECT_NEAR(angles[0], std::atan(turn * h), 1e-9);
      for (std::size_t i = 1; i < angles.size(); ++i)
        ASSERT_NEAR(angles[i], std::atan(std::sin(angles[i - 1]) / (2 - std::cos(angles[i - 1]))),
                    1e-9)
            << "step " << i;
      // Its differential equation, Omega' = -h Omega^3, to first order in h.
      EXPECT_NEAR(angles.back() / h, turn / std::sqrt(1 + 2 * turn * turn * h), turn * turn * h);
    }
  }
}

// The same by methods that go edge by edge, as far as they converge: 0.747 by the law above.
TEST(SpinningNet, IsDampedAlikeByStrainLimiting) {
  for (const char* solver : {"gauss_seidel", "gauss_seidel_colored", "jacobi", "yarn_projection"}) {
    EXPECT_NEAR(step_angles(solver, 0.01).back() / 0.01 / turn, 0.747, 0.01) << solver;
  }
}

TEST(SpinningNet, LosesNothingWhereDirectionsAreOfTheStart) {
  for (const double h : {0.04, 0.01}) {
    for (const double angle : step_angles("shake", h))
      ASSERT_NEAR(angle, std::asin(turn * h), 1e-9);
  }
  const std::vector<double> angles = step_angles("rattle", 0.01);
  for (const double angle : angles) ASSERT_NEAR(angle, angles[0], 1e-9);
}

}  // namespace
}  // namespace harness
