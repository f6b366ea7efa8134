#include "harness/stability/trial.h"

#include <cmath>
#include <optional>
#include <sstream>

#include "harness/base/clock.h"
#include "harness/stability/trial_judge.h"
#include "solvers/registry.h"
#include "solvers/stepping/step_controller.h"

namespace harness {
namespace {

using inextensible::State;

inextensible::Settings settings_of(const Trial& trial, const inextensible::Backend& backend) {
  inextensible::Settings settings;
  if (const auto own = trial.settings.find(backend.name); own != trial.settings.end())
    settings = own->second;
  if (backend.knob == inextensible::Knob::stiffness && std::isfinite(trial.stiffness))
    settings.try_emplace("stiffness", trial.stiffness);
  return settings;
}

// One attempt, with or without the step controller.
Outcome attempt(const Trial& trial, const inextensible::Backend& backend, std::uint64_t seed,
                bool controlled, TrialResult& result) {
  const auto begin = Clock::now();
  inextensible::check_state(*trial.scene.problem, trial.scene.start);
  const auto stepper = inextensible::make_stepper(
      backend.name, trial.scene.problem, {trial.strain_limit, seed, settings_of(trial, backend)});
  inextensible::StepController controller(
      *stepper, {.largest = trial.step, .most_halvings = controlled ? 10 : 0});
  State state = trial.scene.start;
  TrialJudge judge(trial, backend);
  std::optional<Outcome> outcome;
  const double timeout = controlled ? trial.timeout_smaller : trial.timeout;
  for (int i = 0; i < trial.steps && !outcome;) {
    if (trial.disturb && controller.aligned()) trial.disturb(state, i);
    judge.before(state);
    const auto factorizations = stepper->work().factorizations;
    const auto step = controller.advance(state);
    if (!step) {
      std::ostringstream text;
      text << "step " << stepper->work().steps << ": " << inextensible::to_string(step.status)
           << ", " << step.detail;
      if (step.worst_edge >= 0) text << "; edge " << step.worst_edge;
      result.detail = text.str();
      outcome = Outcome::refused;
      break;
    }
    if (stepper->work().factorizations > factorizations) {
      const double condition = stepper->reciprocal_condition();
      if (!(condition >= result.reciprocal_condition)) result.reciprocal_condition = condition;
    }
    outcome = judge.after(stepper->filtered_positions(), state, controller.last(), result);
    if (controller.aligned()) ++i;
    if (!outcome && i < trial.steps && since(begin) > timeout) {
      result.detail = "stopped after " + std::to_string(stepper->work().steps) + " steps";
      outcome = Outcome::timeout;
    }
  }
  if (!outcome) outcome = judge.finish(result);
  result.work = stepper->work();
  if (controlled) result.smallest_step = controller.smallest();
  return outcome.value_or(Outcome::survived);
}

}  // namespace

const char* to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::survived:
      return "survived";
    case Outcome::survived_smaller:
      return "survived_smaller";
    case Outcome::refused:
      return "refused";
    case Outcome::diverged:
      return "diverged";
    case Outcome::wrong:
      return "wrong";
    case Outcome::timeout:
      return "timeout";
    case Outcome::crashed:
      return "crashed";
  }
  return "?";
}

TrialResult run_trial(const std::function<Trial()>& build, const std::string& solver,
                      std::uint64_t seed) {
  TrialResult result;
  const auto begin = Clock::now();
  const inextensible::Backend& backend = *inextensible::find_backend(solver);
  try {
    const Trial trial = build();
    result.fixed = result.outcome = attempt(trial, backend, seed, false, result);
    if (result.fixed == Outcome::refused) {
      TrialResult again;
      again.outcome = attempt(trial, backend, seed, true, again);
      again.fixed = result.fixed;
      if (again.outcome == Outcome::survived) again.outcome = Outcome::survived_smaller;
      again.detail = result.detail + (again.detail == result.detail || again.detail.empty()
                                          ? ""
                                          : "; with smaller steps: " + again.detail);
      result = std::move(again);
    }
  } catch (const std::invalid_argument& error) {
    result.fixed = result.outcome = Outcome::refused;
    result.detail = std::string("at the door: ") + error.what();
  } catch (const std::bad_alloc&) {
    result.fixed = result.outcome = Outcome::refused;
    result.detail = "an allocation failed";
  }
  result.seconds = since(begin);
  return result;
}

}  // namespace harness
