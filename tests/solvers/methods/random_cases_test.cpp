// Every backend against thousands of random problems: graphs from trees to locked ones, masses over
// six decades, velocities over three, starts on and off the manifold, steps that are often absurd.
// Whatever happens: an honest step or a clean refusal. RANDOM_CASES=n runs n cases a backend.
#include <gtest/gtest.h>

#include <cstdlib>

#include "harness/stability/trial_judge.h"
#include "inextensible/registry.h"
#include "inextensible/systems/constraint_system.h"
#include "support/random_graph.h"

namespace inextensible {
namespace {

using harness::Trial;
using harness::TrialResult;
using harness::Witness;
using testing::Random;
using testing::uniform;

int cases() {
  const char* wanted = std::getenv("RANDOM_CASES");
  return wanted ? std::atoi(wanted) : 1000;
}

// The backend's own sweep limit is meant for real problems; here most of them are hopeless.
Settings impatient(const std::string& backend) {
  if (backend == "jacobi" || backend.starts_with("gauss_seidel"))
    return {{"max_iterations", 300.0}};
  return {};
}

Trial random_trial(Random& random) {
  const int n = 8 + static_cast<int>(random() % 9);
  const int pinned = static_cast<int>(random() % 3);
  // A framework of n vertices in space has about 3 n degrees of freedom: more edges lock it.
  const int room = n * (n - 1) / 2 - (n - 1) - 1;  // of the complete graph, pins apart
  const int extra = static_cast<int>(random() % static_cast<std::uint64_t>(std::min(2 * n, room)));
  auto graph = testing::random_graph(random, n, extra, pinned, 1e-6);
  Trial trial;
  trial.scene.problem = graph.problem;
  const bool on_the_manifold = random() % 2 == 0;
  trial.scene.start.x =
      on_the_manifold ? graph.x
                      : testing::perturbed(random, graph, std::pow(10, uniform(random, -3, 0)));
  const double speed = std::pow(10, uniform(random, -1, 2));
  trial.scene.start.v = (testing::perturbed(random, graph, 1) - graph.x) * speed;
  trial.step = std::pow(10, uniform(random, -4, -1));
  trial.strain_limit = std::pow(10, uniform(random, -4, -1));
  trial.energy_tolerance = -1;  // what these starts release has no useful bound
  // Locked graphs have multipliers that cancel; their size is bounded by the pivots that a
  // factorization accepts.
  trial.momentum_tolerance = 1e-5;
  static_assert(1e-5 > 1e-16 / ConstraintSystem::least_pivot);
  return trial;
}

class RandomCases : public ::testing::TestWithParam<const char*> {};

TEST_P(RandomCases, GiveAnHonestStepOrACleanRefusal) {
  const std::string backend = GetParam();
  const bool limited = find_backend(backend)->knob == Knob::strain_limit;
  int steps = 0;
  for (int seed = 1; seed <= cases(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const Trial trial = random_trial(random);
    const auto stepper =
        make_stepper(backend, trial.scene.problem, {trial.strain_limit, 1, impatient(backend)});
    Witness witness(trial, *find_backend(backend));
    TrialResult result;
    State state = trial.scene.start;
    for (int i = 0; i < 4; ++i) {
      const State before = state;
      witness.before(state);
      const StepResult step = stepper->advance(state, trial.step);
      if (!step) {
        EXPECT_TRUE(state.x == before.x && state.v == before.v && state.time == before.time)
            << "a refused step changed the state";
        EXPECT_STRNE(step.detail, "") << "refused without a reason";
        break;
      }
      ++steps;
      const auto outcome = witness.after(stepper->filtered_positions(), state, trial.step, result);
      // Springs may stretch as far as they like.
      if (outcome && !(outcome == harness::Outcome::diverged && !limited))
        ADD_FAILURE() << to_string(*outcome) << ": " << result.detail;
      if (outcome) break;
    }
  }
  EXPECT_GT(steps, cases() / 2) << "hardly any step was taken: this tests nothing";
}

std::vector<const char*> contestants() {
  std::vector<const char*> names;
  for (const Backend& backend : backends()) {
    if (backend.contestant) names.push_back(backend.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, RandomCases, ::testing::ValuesIn(contestants()),
                         [](const auto& parameter) { return std::string(parameter.param); });

}  // namespace
}  // namespace inextensible
