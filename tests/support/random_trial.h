// A random problem, stepped a few times by a solver and judged from outside: whatever happens, an
// honest step or a clean refusal.
#pragma once

#include "harness/stability/trial.h"
#include "solvers/registry.h"
#include "solvers/systems/constraint_system.h"
#include "support/random_graph.h"

namespace inextensible::testing {

using harness::Trial;

// The backend's own sweep limit is meant for real problems; here most of them are hopeless.
inline Settings impatient(const std::string& backend) {
  if (backend.starts_with("yarn_projection") || backend.starts_with("fast_projection_adaptive"))
    return {{"max_iterations", 20.0}};
  if (backend.starts_with("jacobi") || backend.starts_with("gauss_seidel"))
    return {{"max_iterations", 300.0}};
  if (backend.starts_with("admm") || backend.starts_with("augmented_vbd"))
    return {{"max_iterations", 3000.0}};
  return {};
}

inline Trial random_trial(Random& random) {
  const int n = 8 + static_cast<int>(random() % 9);
  const int pinned = static_cast<int>(random() % 3);
  // A framework of n vertices in space has about 3 n degrees of freedom: more edges lock it.
  const int room = n * (n - 1) / 2 - (n - 1) - 1;  // of the complete graph, pins apart
  const int extra = static_cast<int>(random() % static_cast<std::uint64_t>(std::min(2 * n, room)));
  auto graph = random_graph(random, n, extra, pinned, 1e-6);
  Trial trial;
  trial.scene.problem = graph.problem;
  const bool on_the_manifold = random() % 2 == 0;
  trial.scene.start.x =
      on_the_manifold ? graph.x : perturbed(random, graph, std::pow(10, uniform(random, -3, 0)));
  const double speed = std::pow(10, uniform(random, -1, 2));
  trial.scene.start.v = (perturbed(random, graph, 1) - graph.x) * speed;
  trial.step = std::pow(10, uniform(random, -4, -1));
  trial.strain_limit = std::pow(10, uniform(random, -4, -1));
  trial.energy_tolerance = -1;  // what these starts release has no useful bound
  // Locked graphs have multipliers that cancel; their size is bounded by the pivots that a
  // factorization accepts.
  trial.momentum_tolerance = 1e-5;
  static_assert(1e-5 > 1e-16 / ConstraintSystem::least_pivot);
  return trial;
}

struct Attempt {
  int steps = 0;       // that were taken
  std::string defect;  // "": a promise was kept all the time
};

// A few steps of the trial.
inline Attempt attempt(const Trial& trial, const std::string& backend, const Settings& settings) {
  Attempt result;
  const bool limited = find_backend(backend)->strain_control == StrainControl::strain_limit;
  const auto stepper =
      make_stepper(backend, trial.scene.problem, {trial.strain_limit, 1, settings});
  harness::TrialResult judged;
  harness::TrialJudge judge(trial, *find_backend(backend), *stepper, judged);
  State state = trial.scene.start;
  for (int i = 0; i < 4; ++i) {
    const State before = state;
    judge.before(state, {});
    const StepResult step = stepper->advance(state, trial.step);
    if (!step) {
      if (!(state.x == before.x && state.v == before.v && state.time == before.time))
        result.defect = "a refused step changed the state";
      if (!*step.detail) result.defect = "refused without a reason";
      return result;
    }
    ++result.steps;
    if (judge.after(stepper->filtered_positions(), state, trial.step)) continue;
    const harness::Outcome outcome = judge.finish();
    // Springs may stretch as far as they like.
    if (outcome != harness::Outcome::diverged || limited)
      result.defect = std::string(to_string(outcome)) + ": " + judged.detail;
    return result;
  }
  return result;
}

}  // namespace inextensible::testing
