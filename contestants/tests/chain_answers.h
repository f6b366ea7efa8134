// Tests that every engine in joint coordinates must pass.
#pragma once

#include "contestants/tests/known_scenes.h"

namespace engines {

// fine: settings whose error after a second is far below 1e-6 at steps of 1 ms.
inline void expect_a_chain(const std::string& solver, const Settings& fine) {
  EXPECT_LT(pendulum_error(solver, 1000, fine), 1e-8);

  // In a plane of its own the chain takes one angle a link, in another plane two.
  const Scene flat = chain(6), turned = chain(6, 0.7);
  const auto in_plane = run(solver, flat, 1e-3, 300, fine);
  const auto in_space = run(solver, turned, 1e-3, 300, fine);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()).matrix();
  EXPECT_LT(distance(turn * in_plane.x, in_space.x), 1e-7);
  EXPECT_LT(distance(turn * in_plane.v, in_space.v), 1e-5);

  // Gravity along y changes neither energy nor the angular momentum about y.
  const Scene swirl = swirling_chain(6);
  const auto end = run(solver, swirl, 1e-3, 300, fine);
  EXPECT_GT(distance(end.x, swirl.start.x), 0.1);
  EXPECT_LT(largest_strain(swirl, end), 1e-12);
  const auto energy = [&swirl](const State& state) {
    return kinetic_energy(*swirl.problem, state.v) + potential_energy(*swirl.problem, state.x);
  };
  EXPECT_NEAR(energy(end), energy(swirl.start), 1e-6);
  EXPECT_NEAR(angular_momentum(swirl, end).y(), angular_momentum(swirl, swirl.start).y(), 1e-7);
}

// A step of almost no time changes nothing.
inline void expect_copies(const std::string& solver) {
  for (const Scene& scene : {chain(9), chain(9, 0.7), swirling_chain(9)}) {
    const auto after = run(solver, scene, 1e-12, 1);
    EXPECT_LT(distance(after.x, scene.start.x), 1e-11);
    EXPECT_LT(distance(after.v, scene.start.v), 1e-8);
    EXPECT_TRUE(after.x.col(0) == scene.start.x.col(0));
  }
}

// Vertices may be numbered in any order, masses and lengths may differ. Level links carry no load
// across them: every vertex falls freely at first.
inline void expect_unlike_links(const std::string& solver) {
  Positions x = Positions::Zero(3, 3);
  x.row(0) << 1.75, 1, 1.25;  // vertex 1 is the pin, then 2, then 0
  ProblemParts parts = parts_at_rest(x, {{0, 2}, {1, 2}}, {0.3, 1, 2}, {1});
  parts.gravity = {0, -9.81, 0};
  const Scene scene = finished(parts, x, Positions::Zero(3, 3));
  const double h = 1e-5;
  const auto after = run(solver, scene, h, 1);
  EXPECT_NEAR(after.v(1, 0), -9.81 * h, 1e-9);
  EXPECT_NEAR(after.v(1, 2), -9.81 * h, 1e-9);
  EXPECT_LT(largest_strain(scene, run(solver, scene, 1e-3, 100)), 1e-12);
}

// A stepper made in a plane that leaves it equals one made in space, including its settings.
inline void expect_leaves_the_plane(const std::string& solver, const Settings& settings) {
  const Scene flat = chain(5), swirl = swirling_chain(5);
  const auto leaves = make(solver, flat, settings), stays = make(solver, swirl, settings);
  State state = flat.start, expected = swirl.start;
  ASSERT_TRUE(leaves->advance(state, 1e-3));
  state = swirl.start;
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(leaves->advance(state, 1e-3));
    ASSERT_TRUE(stays->advance(expected, 1e-3));
  }
  EXPECT_TRUE(state.x == expected.x && state.v == expected.v);
  EXPECT_GT(distance(run(solver, swirl, 1e-3, 5).x, state.x), 0);  // settings that matter
}

// A link without a direction.
inline void expect_collapse_refused(const std::string& solver) {
  const Scene scene = chain(5);
  State collapsed = scene.start;
  collapsed.x.col(3) = collapsed.x.col(2);
  expect_refusal_without_trace(solver, scene, collapsed, 1e-3);
}

// Other problems are refused with a reason.
inline void expect_chains_only(const std::string& solver) {
  const auto expect_unsupported = [&solver](const Scene& scene, const std::string& why) {
    try {
      make(solver, scene);
      FAIL() << solver << " takes it";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  const auto [problem, start] = chain(3);
  ProblemParts parts = inextensible::testing::parts_of(*problem);
  parts.pinned.clear();
  expect_unsupported(finished(parts, start.x, start.v), "0 vertices are pinned");
  parts.pinned = {0};
  parts.edges.back() = {1, 3};
  expect_unsupported(finished(parts, start.x, start.v), "vertex 1 has more than two edges");
  parts.edges.pop_back();
  parts.rest_length.pop_back();
  expect_unsupported(finished(parts, start.x, start.v), "do not hang on the pin");
}

}  // namespace engines
