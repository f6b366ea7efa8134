#include "harness/stability/trial.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "harness/base/clock.h"
#include "harness/base/small_runs.h"
#include "harness/base/text.h"
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

// One attempt, at the trial's own step or with smaller ones where it is refused.
Outcome attempt(const Trial& trial, const inextensible::Backend& backend, std::uint64_t seed,
                bool smaller, TrialResult& result) {
  const auto begin = Clock::now();
  inextensible::check_state(*trial.scene.problem, trial.scene.start);
  const auto stepper = inextensible::make_stepper(
      backend.name, trial.scene.problem, {trial.strain_limit, seed, settings_of(trial, backend)});
  State state = trial.scene.start;
  TrialJudge judge(trial, backend, *stepper, result);
  const DriveState driven = drive(*stepper, state, {trial.step, trial.steps, smaller ? 10 : 0},
                                  judge, {smaller ? trial.timeout_smaller : trial.timeout, begin});
  result.work = stepper->work();
  if (smaller) result.smallest_step = driven.smallest;
  if (driven.end == DriveState::End::refused) {
    const inextensible::StepResult& step = driven.result;
    result.detail = "step " + std::to_string(result.work.steps) + ": " + to_string(step.status) +
                    ", " + step.detail;
    if (step.worst_edge >= 0) result.detail += "; edge " + std::to_string(step.worst_edge);
    return Outcome::refused;
  }
  if (driven.end == DriveState::End::timed_out) {
    result.detail = "stopped after " + std::to_string(result.work.steps) + " steps";
    return Outcome::timeout;
  }
  return judge.finish();
}

}  // namespace

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
  const std::string name = from.get<std::string>();
  const auto place = std::ranges::find(outcomes, name, &OutcomeInfo::name);
  if (place == std::end(outcomes))
    throw json::other_error::create(502, "'" + name + "' is no outcome of a trial", nullptr);
  outcome = static_cast<Outcome>(place - outcomes);
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

TrialResult run_isolated_trial(const std::function<Trial()>& build, const std::string& solver,
                               std::uint64_t seed, const std::function<bool()>& interrupted) {
  // A trial looks at its own clock between steps; this is for steps that do not end.
  constexpr double longest = 150;  // s, both attempts
  return in_child(
      {longest, 0, interrupted},
      [&](Heartbeat& /*heartbeat*/) { return to_json(run_trial(build, solver, seed)); },
      trial_result_of,
      [](const ChildOutcome& child) {
        const bool stuck = child.end == ChildOutcome::End::timed_out;
        TrialResult result;
        result.fixed = result.outcome = stuck ? Outcome::timeout : Outcome::crashed;
        result.detail =
            stuck ? "a step did not end within " + number_text(longest) + " s" : ending(child);
        return result;
      });
}

}  // namespace harness
