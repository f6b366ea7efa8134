#include "harness/stability/trial_judge.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "harness/base/text.h"
#include "harness/judge/mechanics.h"
#include "solvers/problem/forces.h"

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::State;

constexpr double time_rounding = 1e-6;     // s
constexpr double visible_depth = 1e-6;     // in scene sizes
constexpr double diverged_distance = 1e6;  // in scene sizes

Outcome fail(TrialResult& result, Outcome outcome, const std::string& why) {
  result.detail = why;
  return outcome;
}

}  // namespace

TrialJudge::TrialJudge(const Trial& trial, const inextensible::Backend& backend)
    : trial_(trial),
      problem_(*trial.scene.problem),
      limit_promised_(backend.strain_control == inextensible::StrainControl::strain_limit),
      mass_(problem_.total_mass()),
      free_(backend.conserves_momentum && problem_.pinned().empty() && !problem_.collider()),
      energy_(problem_, energy_scale(trial.scene), backend.velocities) {
  judged_ = trial.energy_tolerance >= 0 && !trial.disturb && energy_.scale() > 0;
  // What a start that violates the limit releases is known after the first step.
  energy_known_ = worst_edge(problem_, trial.scene.start.x).strain <= trial.strain_limit;
  energy_.begin(trial.scene.start);
}

void TrialJudge::before(const State& state) {
  start_ = state;
  if (free_) momentum_ = linear_momentum(problem_, state.v);
}

std::optional<Outcome> TrialJudge::after(const Positions& filtered, const State& state, double h,
                                         TrialResult& result) {
  if (!state.x.allFinite() || !state.v.allFinite())
    return fail(result, Outcome::wrong, "a state that is not finite was accepted");
  const WorstEdge worst = worst_edge(problem_, filtered);
  raise(result.max_strain, worst.strain);
  const double time = state.time - trial_.scene.start.time, duration = trial_.steps * trial_.step;
  if (duration > 2 - time_rounding) {
    if (time < 1 + time_rounding) raise(result.strain_first_second, worst.strain);
    if (time > duration - 1 + time_rounding) raise(result.strain_last_second, worst.strain);
  }
  if (worst.strain > diverged_strain ||
      state.x.cwiseAbs().maxCoeff() > diverged_distance * trial_.scene.size)
    return fail(result, Outcome::diverged, "strain " + number_text(worst.strain));
  if (limit_promised_ && worst.strain > trial_.strain_limit * (1 + 1e-9)) {
    return fail(result, Outcome::wrong,
                "success claimed, but edge " + std::to_string(worst.edge) + " is strained by " +
                    told_apart(worst.strain, trial_.strain_limit));
  }
  if (problem_.contact_inside()) {
    if (const auto outcome = judge_contact(state, result)) return outcome;
  }
  for (const int pin : problem_.pinned()) {
    if (state.x.col(pin) != start_.x.col(pin))
      return fail(result, Outcome::wrong, "pinned vertex " + std::to_string(pin) + " moved");
  }
  if (free_) {
    const double defect = momentum_defect(state, h);
    raise(result.momentum_defect, defect);
    if (!(defect <= trial_.momentum_tolerance))
      return fail(result, Outcome::wrong, "momentum is not conserved, by " + number_text(defect));
  }
  if (!judged_) return {};
  if (!energy_known_) {
    energy_known_ = true;
    energy_.begin(state, std::max(energy_.scale(), total_energy(problem_, state)));
    return {};
  }
  const double of_this_step = 0.5 * mass_ * std::pow(1.5 * trial_.slack / h, 2) / energy_.scale();
  const double before = std::exchange(release_, of_this_step);
  return judge_energy(energy_.after(state, h), std::max(before, of_this_step), result);
}

// What is delivered: positions after everything that a step does.
std::optional<Outcome> TrialJudge::judge_contact(const State& state, TrialResult& result) {
  const WorstEdge worst = worst_edge(problem_, state.x);
  if (limit_promised_ && worst.strain > trial_.strain_limit * (1 + 1e-9)) {
    return fail(result, Outcome::wrong,
                "success claimed, but after the collision filter edge " +
                    std::to_string(worst.edge) + " is strained by " +
                    told_apart(worst.strain, trial_.strain_limit));
  }
  inextensible::WorkCounters work;
  if (!obstacle_) obstacle_.emplace(problem_);
  obstacle_->place(state.time);
  obstacle_->find(state.x, visible_depth * trial_.scene.size, inside_, work);
  if (inside_.empty()) return {};
  return fail(result, Outcome::wrong,
              "success claimed, but vertex " + std::to_string(inside_.front().vertex) +
                  " is inside the obstacle");
}

std::optional<Outcome> TrialJudge::finish(TrialResult& result) {
  if (!judged_ || !energy_known_) return {};
  return judge_energy(energy_.finish(), release_, result);
}

std::optional<Outcome> TrialJudge::judge_energy(std::optional<double> gain, double release,
                                                TrialResult& result) const {
  if (!gain) return {};
  raise(result.energy_gain, *gain);
  if (*gain <= trial_.energy_tolerance + release) return {};
  return fail(result, Outcome::wrong,
              "energy out of nothing, " + number_text(*gain) + " of its scale");
}

// |change of momentum - weight h| over what flows in the step; positions are known to rounding
// only.
double TrialJudge::momentum_defect(const State& state, double h) const {
  const Eigen::Vector3d expected = momentum_ + h * mass_ * problem_.gravity();
  const double fastest = state.v.colwise().norm().maxCoeff() + start_.v.colwise().norm().maxCoeff();
  const double flow =
      mass_ * (fastest + h * problem_.gravity().norm()) + 1e-6 * mass_ * trial_.scene.size / h;
  return (linear_momentum(problem_, state.v) - expected).norm() / flow;
}

}  // namespace harness
