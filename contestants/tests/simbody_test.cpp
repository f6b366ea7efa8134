#include "contestants/tests/chain_answers.h"

namespace engines {
namespace {

const std::string solver = "engine_simbody";

TEST(Simbody, MovesAChain) { expect_a_chain(solver, {{"accuracy", 1e-10}}); }
TEST(Simbody, TakesAndGivesStates) { expect_copies(solver); }
TEST(Simbody, TakesUnlikeLinks) { expect_unlike_links(solver); }
TEST(Simbody, LeavesThePlane) {
  expect_leaves_the_plane(solver, {{"integrator", std::string("verlet")}, {"accuracy", 1e-5}});
}
TEST(Simbody, TakesChainsOnly) { expect_chains_only(solver); }

// The accuracy bounds the error, not the step of the harness.
TEST(Simbody, ErrorFollowsAccuracy) {
  for (const char* integrator : {"merson", "fehlberg", "verlet"}) {
    const auto error = [integrator](double accuracy) {
      return pendulum_error(solver, 2,
                            {{"accuracy", accuracy}, {"integrator", std::string(integrator)}});
    };
    EXPECT_GT(error(1e-3), 10 * error(1e-7)) << integrator;
    EXPECT_LT(error(1e-7), 1e-4) << integrator;
  }
}

// Continuing from its own state and being set again give the same motion.
TEST(Simbody, MayBeInterrupted) {
  const Scene scene = swirling_chain(5);
  const Settings fine{{"accuracy", 1e-9}};
  const auto whole = run(solver, scene, 0.01, 20, fine);
  Scene half = scene;
  half.start = run(solver, scene, 0.01, 10, fine);
  EXPECT_LT(distance(run(solver, half, 0.01, 10, fine).x, whole.x), 1e-7);
}

TEST(Simbody, RefusesWithoutTrace) {
  const Scene scene = chain(2);
  // More than 100,000 internal steps.
  expect_refusal_without_trace(solver, scene, scene.start, 1e9);
  expect_collapse_refused(solver);
}

}  // namespace
}  // namespace engines
