// The cape: it hangs from the body that takes its pins along.
#include <gtest/gtest.h>

#include <stdexcept>

#include "harness/scenes/scene.h"
#include "solvers/problem/triangle_collider.h"
#include "solvers/registry.h"

namespace harness {
namespace {

Scene cape(const SceneParameters& given) {
  const auto type = find_scene("cape");
  return type->build(complete_parameters(*type, given));
}

TEST(Cape, HangsFromTheMovingBody) {
  const Scene scene = cape({{"n", 15}});
  const inextensible::Problem& problem = *scene.problem;
  ASSERT_GT(problem.pinned().size(), 2U);
  ASSERT_LT(problem.pinned().size(), 15U) << "a part of the collar";
  inextensible::State state = scene.start;
  const auto stepper =
      inextensible::make_stepper("fast_projection", scene.problem, {0.01, 1, {}, &state});
  while (state.time < 1.5) ASSERT_TRUE(stepper->advance(state, 1.0 / 120));
  const inextensible::Pose pose = problem.body_motion()(state.time);
  EXPECT_GT(pose.translation.norm(), 0.1);
  for (const int pin : problem.pinned())
    EXPECT_LT((state.x.col(pin) - pose(scene.start.x.col(pin))).norm(), 1e-9);
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    const auto [a, b] = problem.edges()[k];
    EXPECT_LT((state.x.col(b) - state.x.col(a)).norm(), 1.0101 * problem.rest_length()[k]);
  }
}

TEST(Cape, StartsOutsideItsBody) {
  const Scene scene = cape({});
  const auto* body = dynamic_cast<const inextensible::TriangleCollider*>(scene.problem->collider());
  ASSERT_NE(body, nullptr);
  for (const auto& x : scene.start.x.colwise()) EXPECT_GT(body->nearest(x).signed_distance, 0);
}

TEST(Cape, CountsWhatItBuilds) {
  const auto type = find_scene("cape");
  const SceneParameters p = complete_parameters(*type, {{"n", 15}});
  const Scene scene = type->build(p);
  EXPECT_EQ(type->counts(p),
            std::make_pair(scene.problem->vertices(), scene.problem->constraints()));
}

TEST(Cape, WithAHemThatIsTooWideIsRefused) {
  EXPECT_THROW(cape({{"flare", 20}}), std::invalid_argument);
}

}  // namespace
}  // namespace harness
