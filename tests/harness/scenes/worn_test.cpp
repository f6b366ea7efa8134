// The garment: a skirt that its rim holds, against the geometry of the body that it is on; and the
// cape, which hangs from the body that takes its pins along.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "harness/judge/drive.h"
#include "harness/judge/mechanics.h"
#include "harness/scenes/scene.h"
#include "solvers/registry.h"

namespace harness {
namespace {

using inextensible::Pose;
using inextensible::State;

constexpr int around = 24;

Scene still_garment() {
  return built_scene("garment", {{"n", around}, {"sway", 0}, {"turn", 0}, {"friction", 0.05}});
}

// By yarns, and a step that a tight rim refuses is halved: fast projection is thrown off a tight
// rim in one build and not in another.
State after(const Scene& scene, double limit, double seconds) {
  const double h = 1.0 / 400;
  State state = scene.start;
  const auto stepper =
      inextensible::make_stepper("yarn_projection", scene.problem, {limit, 1, {}, &state});
  const DriveState driven = drive(*stepper, state, {h, std::lround(seconds / h), usual_halvings});
  EXPECT_EQ(driven.end, DriveState::End::arrived) << state.time << " s: " << driven.result.detail;
  return state;
}

// It slides down until its rim is taut where the body is as wide as that: circumference over
// 2 pi is the rim's radius and at most the strain limit more.
TEST(Garment, RestsWhereTheBodyIsAsWideAsItsRimMayBe) {
  const Scene scene = still_garment();
  const double limit = 0.01, rim = 0.13, waist = 0.115, hips = 0.137, drop = 0.12;
  const State state = after(scene, limit, 1.5);
  for (int v = 0; v < around; ++v) {
    const double y = state.x(1, v);
    ASSERT_GT(y, -drop) << "vertex " << v;
    const double radius =
        waist + (hips - waist) * 0.5 * (1 - std::cos(std::numbers::pi * y / drop));
    EXPECT_GT(radius, rim * (1 - limit)) << "vertex " << v;
    EXPECT_LT(radius, rim * (1 + limit) * 1.005) << "vertex " << v;
  }
}

TEST(Garment, SlipsPastHipsThatItsRimMayPass) {
  EXPECT_LT(after(still_garment(), 0.1, 1).x.row(1).head(around).maxCoeff(), -0.12);
}

TEST(Garment, ItsBodyStartsAtRestWhereItIs) {
  const Scene scene = built_scene("garment", {{"n", around}});
  const auto& motion = scene.problem->body_motion();
  const Pose start = motion(0), soon = motion(1e-4);
  EXPECT_EQ(start.turn, Eigen::Matrix3d::Identity());
  EXPECT_EQ(start.translation, Eigen::Vector3d::Zero().eval());
  EXPECT_LT((soon.turn - start.turn).norm() + (soon.translation - start.translation).norm(), 1e-9);
  EXPECT_FALSE(built_scene("garment", {{"sway", 0}, {"turn", 0}}).problem->body_motion());
}

TEST(Cape, HangsFromTheMovingBody) {
  const Scene scene = built_scene("cape", {{"n", 15}});
  const inextensible::Problem& problem = *scene.problem;
  ASSERT_GT(problem.pinned().size(), 2U);
  ASSERT_LT(problem.pinned().size(), 15U) << "a part of the collar";
  State state = scene.start;
  const auto stepper =
      inextensible::make_stepper("fast_projection", scene.problem, {0.01, 1, {}, &state});
  while (state.time < 1.5) ASSERT_TRUE(stepper->advance(state, 1.0 / 120));
  const Pose pose = problem.body_motion()(state.time);
  EXPECT_GT(pose.translation.norm(), 0.1);
  for (const int pin : problem.pinned())
    EXPECT_LT((state.x.col(pin) - pose(scene.start.x.col(pin))).norm(), 1e-9);
  EXPECT_LT(strain_range(problem, state.x).stretch, 0.0101);
}

}  // namespace
}  // namespace harness
