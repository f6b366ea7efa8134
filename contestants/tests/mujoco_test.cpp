#include "contestants/tests/chain_answers.h"

namespace engines {
namespace {

const std::string solver = "engine_mujoco";
const auto word = [](const char* integrator) {
  return Settings{{"integrator", std::string(integrator)}};
};

TEST(Mujoco, MovesAChain) { expect_a_chain(solver, word("rk4")); }
TEST(Mujoco, TakesAndGivesStates) { expect_copies(solver); }
TEST(Mujoco, TakesUnlikeLinks) { expect_unlike_links(solver); }
TEST(Mujoco, LeavesThePlane) { expect_leaves_the_plane(solver, word("implicit")); }
TEST(Mujoco, TakesChainsOnly) { expect_chains_only(solver); }

// More links than one file may have: a long chain hangs at rest, every mass in its place.
TEST(Mujoco, TakesLongChains) {
  const Scene scene = hanging_chain(200);
  EXPECT_LT(distance(run(solver, scene, 1e-3, 2).x, scene.start.x), 1e-12);
}

TEST(Mujoco, IntegratorsHaveTheirOrders) {
  const auto order = [](const char* integrator) {
    return std::log2(pendulum_error(solver, 100, word(integrator)) /
                     pendulum_error(solver, 200, word(integrator)));
  };
  EXPECT_NEAR(order("rk4"), 4, 0.3);
  EXPECT_GT(order("euler"), 0.8);
  EXPECT_GT(order("implicit"), 0.8);
}

TEST(Mujoco, RefusesWithoutTrace) {
  const Scene scene = chain(5);
  State fast = scene.start;
  fast.v(1, 5) = 1e12;  // MuJoCo takes no number beyond 1e10
  expect_refusal_without_trace(solver, scene, fast, 1e-3);
  expect_collapse_refused(solver);
}

}  // namespace
}  // namespace engines
