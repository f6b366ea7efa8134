// The energy record against motions whose energies are known: free fall, which gains nothing
// however coarse its steps; a vibration that turns round in every step, which has the energy that
// it has; and a kick.
#include "harness/judge/energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "harness/judge/mechanics.h"

namespace harness {
namespace {

using inextensible::State;
using inextensible::Velocities;

constexpr double g = 10;

// One edge of 1 m, two vertices of 1 kg, thrown upwards with this speed, m/s.
Scene pair_of_vertices(double speed = 0) {
  inextensible::ProblemParts parts;
  parts.mass = {1, 1};
  parts.edges = {{0, 1}};
  parts.rest_length = {1};
  parts.gravity = {0, -g, 0};
  Scene scene;
  scene.problem = std::make_shared<const inextensible::Problem>(std::move(parts));
  scene.start.x.setZero(3, 2);
  scene.start.x(0, 1) = 1;
  scene.start.v.setZero(3, 2);
  scene.start.v.row(1).setConstant(speed);
  return scene;
}

// Where such a pair of 2 m/s is at t = n h, with the mean velocity of the step before.
State thrown(State state, double t, double h) {
  state.time = t;
  state.x.row(1).setConstant(2 * t - 0.5 * g * t * t);
  state.v.row(1).setConstant(2 - g * (t - 0.5 * h));
  return state;
}

TEST(EnergyRecord, DoesNotTakeTheLagOfHalfStepVelocitiesForAGain) {
  const Scene scene = pair_of_vertices(2);
  for (const double h : {0.04, 0.02}) {
    EnergyRecord halves(scene, Velocities::half_step), whole(scene, Velocities::whole_step);
    for (int n = 1; n * h < 0.2; ++n) {  // it rises, and slows down
      halves.after(thrown(scene.start, n * h, h), h);
      whole.after(thrown(scene.start, n * h, h), h);
    }
    halves.finish();
    // What is left is of second order: m (g h / 2)^2 / 2 of each vertex. At the last step, without
    // one after it, energy is underestimated.
    const double second = 2 * 0.5 * std::pow(0.5 * g * h, 2) / halves.scale();
    EXPECT_NEAR(halves.gain(), second, 1e-12);
    EXPECT_GT(whole.gain(), 10 * second) << "the lag itself, of first order";
  }
}

TEST(EnergyRecord, SeesAVibrationThatTurnsRoundInEveryStep) {
  const Scene scene = pair_of_vertices();
  EnergyRecord record(scene, Velocities::half_step);
  State state = scene.start;
  for (int n = 1; n <= 10; ++n) {
    state.time = 0.01 * n;
    state.v.row(0) << (n % 2 == 0 ? 3 : -3), (n % 2 == 0 ? -3 : 3);
    record.after(state, 0.01);
  }
  EXPECT_NEAR(record.gain(), 9 / (2 * g), 1e-12);
}

// The gain of a loss throughout is negative.
TEST(EnergyRecord, TellsWhenEnergyWasHighest) {
  const Scene scene = pair_of_vertices();
  EnergyRecord record(scene, Velocities::whole_step);
  State state = scene.start;
  for (int n = 1; n <= 5; ++n) {
    state.time = 0.1 * n;
    state.x.row(1).setConstant(n == 3 ? -0.25 : -1);
    const auto gain = record.after(state, 0.1);
    ASSERT_TRUE(gain);
    EXPECT_NEAR(*gain, n == 3 ? -0.25 : -1, 1e-12);
  }
  EXPECT_FALSE(record.finish());
  EXPECT_NEAR(record.gain(), -0.25, 1e-12);
  EXPECT_NEAR(record.gain_time(), 0.3, 1e-12);
  EXPECT_EQ(record.gain_step(), 3);
  EXPECT_NEAR(record.drift(), 1, 1e-12);
}

// Steps of different lengths: the end of the first is nearer the middle of the shorter one.
TEST(EnergyRecord, InterpolatesBetweenUnequalSteps) {
  const Scene scene = pair_of_vertices();
  EnergyRecord record(scene, Velocities::half_step);
  State state = scene.start;
  state.v(0, 0) = 2;  // 2 J
  EXPECT_FALSE(record.after(state, 0.3));
  state.v(0, 0) = 4;  // 8 J
  const auto gain = record.after(state, 0.1);
  ASSERT_TRUE(gain);
  EXPECT_NEAR(*gain, (0.1 * 2 + 0.3 * 8) / 0.4 / (2 * g), 1e-12);
}

}  // namespace
}  // namespace harness
