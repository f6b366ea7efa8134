#include "harness/stability/trial_judge.h"

#include <cmath>

#include "harness/base/text.h"
#include "harness/judge/measures.h"
#include "inextensible/problem/forces.h"

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::State;

constexpr double diverged_distance = 1e6;  // in scene sizes

Outcome fail(TrialResult& result, Outcome outcome, const std::string& why) {
  result.detail = why;
  return outcome;
}

}  // namespace

Witness::Witness(const Trial& trial, bool limit_promised)
    : trial_(trial),
      problem_(*trial.scene.problem),
      limit_promised_(limit_promised),
      mass_(problem_.total_mass()),
      free_(problem_.pinned().empty() && !problem_.collider()) {
  scale_ = energy_scale(trial.scene) + inextensible::kinetic_energy(problem_, trial.scene.start.v);
  judged_ = trial.energy_tolerance >= 0 && !trial.disturb && scale_ > 0;
  // What a start that violates the limit releases is known after the first step.
  if (worst_edge(problem_, trial.scene.start.x).strain <= trial.strain_limit)
    energy_ = total_energy(problem_, trial.scene.start);
}

void Witness::before(const State& state) {
  start_ = state;
  if (free_) momentum_ = linear_momentum(problem_, state.v);
}

std::optional<Outcome> Witness::after(const Positions& filtered, const State& state, double h,
                                      TrialResult& result) {
  if (!state.x.allFinite() || !state.v.allFinite())
    return fail(result, Outcome::wrong, "a state that is not finite was accepted");
  const WorstEdge worst = worst_edge(problem_, filtered);
  raise(result.max_strain, worst.strain);
  if (worst.strain > diverged_strain ||
      state.x.cwiseAbs().maxCoeff() > diverged_distance * trial_.scene.size)
    return fail(result, Outcome::diverged, "strain " + number_text(worst.strain));
  if (limit_promised_ && worst.strain > trial_.strain_limit * (1 + 1e-9)) {
    return fail(result, Outcome::wrong,
                "success claimed, but edge " + std::to_string(worst.edge) + " is strained by " +
                    told_apart(worst.strain, trial_.strain_limit));
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
  if (!energy_) {
    energy_ = total_energy(problem_, state);
    scale_ = std::max(scale_, *energy_);
    return {};
  }
  const double gain = (total_energy(problem_, state) - *energy_) / scale_;
  raise(result.energy_gain, gain);
  const double release = 0.5 * mass_ * std::pow(1.5 * trial_.slack / h, 2) / scale_;
  if (!(gain <= trial_.energy_tolerance + release))
    return fail(result, Outcome::wrong,
                "energy out of nothing, " + number_text(gain) + " of its scale");
  return {};
}

// |change of momentum - weight h| over what flows in the step; positions are known to rounding
// only.
double Witness::momentum_defect(const State& state, double h) const {
  const Eigen::Vector3d expected = momentum_ + h * mass_ * problem_.gravity();
  const double fastest = state.v.colwise().norm().maxCoeff() + start_.v.colwise().norm().maxCoeff();
  const double flow =
      mass_ * (fastest + h * problem_.gravity().norm()) + 1e-6 * mass_ * trial_.scene.size / h;
  return (linear_momentum(problem_, state.v) - expected).norm() / flow;
}

}  // namespace harness
