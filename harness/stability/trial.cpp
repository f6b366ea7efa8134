#include "harness/stability/trial.h"

#include "harness/base/child_process.h"
#include "harness/points/point_json.h"

namespace harness {

TrialJudge::TrialJudge(const Trial& trial, const Backend& backend, const Stepper& stepper,
                       TrialResult& result)
    : trial_(trial),
      problem_(*trial.scene.problem),
      stepper_(stepper),
      result_(result),
      limit_promised_(backend.strain_control == StrainControl::strain_limit),
      mass_(problem_.total_mass()),
      free_(backend.conserves_momentum && problem_.pinned().empty() && !problem_.collider()),
      energy_known_(strain_range(problem_, trial.scene.start.x).most <= trial.strain_limit),
      energy_(trial.scene, backend.velocities) {
  judged_ = trial.energy_tolerance >= 0 && !trial.disturb && energy_.scale() > 0;
}

bool TrialJudge::fail(Outcome outcome, const std::string& why, Promise broken) {
  outcome_ = outcome;
  result_.broken = broken;
  result_.detail = why;
  return false;
}

int TrialJudge::before(State& state, const DriveState& driven) {
  if (trial_.disturb && driven.whole) trial_.disturb(state, static_cast<int>(driven.steps));
  start_ = state;
  work_ = stepper_.work();
  return 1;
}

bool TrialJudge::after(const State& state, const DriveState& driven) {
  return after(stepper_.filtered_positions(), state, driven.last) && judge_counters(driven);
}

// They only grow, but for a factorization's size, which is that of the last one.
bool TrialJudge::judge_counters(const DriveState& driven) {
  const WorkCounters& now = stepper_.work();
  bool falls = false;
  for (const auto& counter : inextensible::work_counters)
    if (const auto* count = std::get_if<std::int64_t WorkCounters::*>(&counter.member))
      falls = falls || now.**count < work_.**count;
  if (falls) return broke(Promise::counters, "a counter fell");
  return (now.steps == work_.steps + 1 && driven.result.iterations >= 0) ||
         broke(Promise::counters, "steps or iterations are wrong");
}

bool TrialJudge::after(const Positions& filtered, const State& state, double h) {
  if (!state.x.allFinite() || !state.v.allFinite())
    return broke(Promise::finite, "a state that is not finite was accepted");
  if (!judge_strain(filtered, state) || !judge_contact(state)) return false;
  for (const int pin : problem_.pinned())
    if (state.x.col(pin) != start_.x.col(pin))
      return broke(Promise::pins, "pinned vertex " + std::to_string(pin) + " moved");
  return judge_momentum(state, h) && judge_energy(state, h);
}

Outcome TrialJudge::finish() {
  if (outcome_ == Outcome::survived && judged_ && energy_known_)
    judge_gain(energy_.finish(), release_);
  return outcome_;
}

bool TrialJudge::judge_strain(const Positions& filtered, const State& state) {
  constexpr double rounding = 1e-6;          // s
  constexpr double diverged_distance = 1e6;  // in scene sizes
  const StrainRange worst = strain_range(problem_, filtered);
  raise(result_.max_strain, worst.most);
  const double time = state.time - trial_.scene.start.time, duration = trial_.steps * trial_.step;
  if (duration > 2 - rounding) {
    if (time < 1 + rounding) raise(result_.strain_first_second, worst.most);
    if (time > duration - 1 + rounding) raise(result_.strain_last_second, worst.most);
  }
  if (worst.most > diverged_strain ||
      state.x.cwiseAbs().maxCoeff() > diverged_distance * trial_.scene.size)
    return fail(Outcome::diverged, "strain " + number_text(worst.most));
  return judge_limit(worst, "");
}

bool TrialJudge::judge_limit(const StrainRange& worst, const char* when) {
  if (!limit_promised_ || worst.most <= trial_.strain_limit * (1 + 1e-9)) return true;
  return broke(Promise::strain,
               concat("success claimed, but ", when, "edge ", worst.edge, " is strained by ",
                      told_apart(worst.most, trial_.strain_limit)));
}

// Looks at what is delivered: positions after everything that a step does.
bool TrialJudge::judge_contact(const State& state) {
  constexpr double visible_depth = 1e-6;  // in scene sizes
  if (!problem_.contact_inside()) return true;
  if (!judge_limit(strain_range(problem_, state.x), "after the collision filter ")) return false;
  WorkCounters work;
  if (!obstacle_) obstacle_.emplace(problem_);
  obstacle_->place(state.time);
  obstacle_->find(state.x, visible_depth * trial_.scene.size, inside_, work);
  if (inside_.empty()) return true;
  return broke(Promise::contact, concat("success claimed, but vertex ", inside_.front().vertex,
                                        " is inside the obstacle"));
}

// |change of momentum - weight h| over what flows in the step; positions are rounded.
bool TrialJudge::judge_momentum(const State& state, double h) {
  if (!free_) return true;
  const Eigen::Vector3d expected =
      linear_momentum(problem_, start_.v) + h * mass_ * problem_.gravity();
  const double fastest = state.v.colwise().norm().maxCoeff() + start_.v.colwise().norm().maxCoeff();
  const double flow =
      mass_ * (fastest + h * problem_.gravity().norm()) + 1e-6 * mass_ * trial_.scene.size / h;
  const double defect = (linear_momentum(problem_, state.v) - expected).norm() / flow;
  raise(result_.momentum_defect, defect);
  return defect <= trial_.momentum_tolerance ||
         broke(Promise::momentum, "momentum is not conserved, by " + number_text(defect));
}

bool TrialJudge::judge_energy(const State& state, double h) {
  if (!judged_) return true;
  if (!energy_known_) {
    energy_known_ = true;
    energy_.begin(state, std::max(energy_.scale(), total_energy(problem_, state)));
    return true;
  }
  const double release = 0.5 * mass_ * std::pow(1.5 * trial_.slack / h, 2) / energy_.scale();
  const double before = std::exchange(release_, release);
  return judge_gain(energy_.after(state, h), std::max(before, release));
}

bool TrialJudge::judge_gain(std::optional<double> gain, double release) {
  if (!gain) return true;
  raise(result_.energy_gain, *gain);
  return *gain <= trial_.energy_tolerance + release ||
         broke(Promise::energy, "energy out of nothing, " + number_text(*gain) + " of its scale");
}

namespace {

// One attempt, at the trial's own step or with smaller ones where it is refused.
Outcome attempt(const Trial& trial, const Backend& backend, std::uint64_t seed, bool smaller,
                TrialResult& result) {
  const auto begin = Clock::now();
  inextensible::check_state(*trial.scene.problem, trial.scene.start);
  Settings settings;
  if (const auto own = trial.settings.find(backend.name); own != trial.settings.end())
    settings = own->second;
  if (backend.strain_control == StrainControl::stiffness && std::isfinite(trial.stiffness))
    settings.try_emplace("stiffness", trial.stiffness);
  const auto stepper =
      make_stepper(backend.name, trial.scene.problem, {trial.strain_limit, seed, settings});
  State state = trial.scene.start;
  TrialJudge judge(trial, backend, *stepper, result);
  const DriveState driven = drive(*stepper, state, {trial.step, trial.steps, smaller ? 10 : 0},
                                  judge, {smaller ? trial.timeout_smaller : trial.timeout, begin});
  result.work = stepper->work();
  if (smaller) result.smallest_step = driven.smallest;
  if (driven.end == DriveState::End::refused) {
    const StepResult& step = driven.result;
    result.detail =
        concat("step ", result.work.steps, ": ", to_string(step.status), ", ", step.detail);
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
  const Backend& backend = *find_backend(solver);
  try {
    const Trial trial = build();
    result.fixed = result.outcome = attempt(trial, backend, seed, false, result);
    if (result.fixed == Outcome::refused) {
      TrialResult again;
      again.outcome = attempt(trial, backend, seed, true, again);
      if (again.outcome == Outcome::survived) again.outcome = Outcome::survived_smaller;
      again.detail = result.detail + (again.detail == result.detail || again.detail.empty()
                                          ? ""
                                          : "; with smaller steps: " + again.detail);
      result = std::move(again);
    }
  } catch (const std::invalid_argument& error) {  // refused, as results are at first
    result.detail = std::string("at the door: ") + error.what();
  } catch (const std::bad_alloc&) {
    result.detail = "an allocation failed";
  }
  result.seconds = since(begin);
  return result;
}

void from_json(const json& name, Outcome& outcome) {
  const auto place = std::ranges::find(outcome_names, name.get<std::string>());
  if (place == std::end(outcome_names))
    throw json::other_error::create(502, name.dump() + " is not the outcome of a trial", nullptr);
  outcome = static_cast<Outcome>(place - outcome_names);
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
        TrialResult result;
        result.fixed = result.outcome =
            child.end == ChildOutcome::End::timed_out ? Outcome::timeout : Outcome::crashed;
        result.detail = ending(child);
        return result;
      });
}

}  // namespace harness
