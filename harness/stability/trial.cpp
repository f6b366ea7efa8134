#include "harness/stability/trial.h"

#include <cmath>
#include <optional>
#include <sstream>

#include "harness/base/clock.h"
#include "harness/judge/drive.h"
#include "harness/stability/trial_judge.h"
#include "solvers/registry.h"

namespace harness {
namespace {

using inextensible::State;

inextensible::Settings settings_of(const Trial& trial, const inextensible::Backend& backend) {
  inextensible::Settings settings;
  if (const auto own = trial.settings.find(backend.name); own != trial.settings.end())
    settings = own->second;
  if (backend.strain_control == inextensible::StrainControl::stiffness &&
      std::isfinite(trial.stiffness))
    settings.try_emplace("stiffness", trial.stiffness);
  return settings;
}

// Disturbs and judges the steps of an attempt.
struct TrialObserver : Observer {
  const Trial& trial;
  const inextensible::Stepper& stepper;
  TrialJudge& judge;
  TrialResult& result;
  std::optional<Outcome> outcome = {};
  std::int64_t factorizations = 0;  // before the step

  int before(State& state, const DriveState& driven) {
    if (trial.disturb && driven.whole) trial.disturb(state, static_cast<int>(driven.steps));
    judge.before(state);
    factorizations = stepper.work().factorizations;
    return 1;
  }

  bool after(const State& state, const DriveState& driven) {
    if (stepper.work().factorizations > factorizations) {
      const double condition = stepper.reciprocal_condition();
      if (!(condition >= result.reciprocal_condition)) result.reciprocal_condition = condition;
    }
    outcome = judge.after(stepper.filtered_positions(), state, driven.last, result);
    return !outcome;
  }
};

std::string refusal(const inextensible::StepResult& step, std::int64_t number) {
  std::ostringstream text;
  text << "step " << number << ": " << inextensible::to_string(step.status) << ", " << step.detail;
  if (step.worst_edge >= 0) text << "; edge " << step.worst_edge;
  return text.str();
}

// One attempt, at the trial's own step or with smaller ones where it is refused.
Outcome attempt(const Trial& trial, const inextensible::Backend& backend, std::uint64_t seed,
                bool smaller, TrialResult& result) {
  const auto begin = Clock::now();
  inextensible::check_state(*trial.scene.problem, trial.scene.start);
  const auto stepper = inextensible::make_stepper(
      backend.name, trial.scene.problem, {trial.strain_limit, seed, settings_of(trial, backend)});
  State state = trial.scene.start;
  TrialJudge judge(trial, backend);
  TrialObserver observer{{}, trial, *stepper, judge, result};
  const DriveState driven =
      drive(*stepper, state, {trial.step, trial.steps, smaller ? 10 : 0}, observer,
            {smaller ? trial.timeout_smaller : trial.timeout, begin});
  result.work = stepper->work();
  if (smaller) result.smallest_step = driven.smallest;
  if (driven.end == DriveState::End::refused) {
    result.detail = refusal(driven.result, result.work.steps);
    return Outcome::refused;
  }
  if (driven.end == DriveState::End::timed_out) {
    result.detail = "stopped after " + std::to_string(result.work.steps) + " steps";
    return Outcome::timeout;
  }
  if (observer.outcome) return *observer.outcome;
  return judge.finish(result).value_or(Outcome::survived);
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
