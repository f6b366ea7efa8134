#include "harness/stability/trial.h"

#include <cmath>
#include <optional>
#include <sstream>
#include <string>

#include "harness/base/child_process.h"
#include "harness/base/clock.h"
#include "harness/base/interrupt.h"
#include "harness/base/json_text.h"
#include "harness/base/text.h"
#include "harness/judge/drive.h"
#include "harness/points/point_json.h"
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

using nlohmann::json;

json FieldCodec<Outcome>::write(Outcome outcome, bool /*nullable*/) { return to_string(outcome); }

void FieldCodec<Outcome>::read(const json& from, Outcome& outcome, bool /*nullable*/) {
  const std::string text = from.get<std::string>();
  for (const Outcome each :
       {Outcome::survived, Outcome::survived_smaller, Outcome::refused, Outcome::diverged,
        Outcome::wrong, Outcome::timeout, Outcome::crashed}) {
    if (text == to_string(each)) {
      outcome = each;
      return;
    }
  }
  throw json::other_error::create(502, "'" + text + "' is no outcome of a trial", nullptr);
}

json to_json(const TrialResult& result) {
  json object;
  write_fields(object, trial_fields, result);
  object["work"] = to_json(result.work);
  return object;
}

TrialResult trial_result_of(const json& object) {
  TrialResult result;
  read_fields(object, trial_fields, result);
  result.work = work_of(object.at("work"));
  return result;
}

namespace {

using End = ChildOutcome::End;

// A trial looks at its own clock between steps; this is for steps that do not end.
constexpr double longest_trial = 150;  // s, both attempts

}  // namespace

TrialResult run_isolated_trial(const std::function<Trial()>& build, const std::string& solver,
                               std::uint64_t seed, const std::function<bool()>& interrupted) {
  ChildOutcome child =
      run_in_child([&](Heartbeat&) { return compact(to_json(run_trial(build, solver, seed))); },
                   {longest_trial, 0, interrupted});
  if (child.end == End::interrupted) throw Interrupted();
  if (const auto result = answer(child, trial_result_of)) return *result;
  TrialResult result;
  const bool stuck = child.end == End::timed_out;
  result.fixed = result.outcome = stuck ? Outcome::timeout : Outcome::crashed;
  result.detail =
      stuck ? "a step did not end within " + number_text(longest_trial) + " s" : ending(child);
  return result;
}

}  // namespace harness
