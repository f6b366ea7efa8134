#include "harness/stability/trial_judge.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "harness/base/text.h"
#include "inextensible/problem/forces.h"

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::Problem;
using inextensible::State;

constexpr double diverged_strain = 10;
constexpr double diverged_distance = 1e6;  // in scene sizes

Eigen::Vector3d momentum(const Problem& problem, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index v = 0; v < state.v.cols(); ++v)
    sum += problem.mass()[static_cast<std::size_t>(v)] * state.v.col(v);
  return sum;
}

void raise(double& figure, double value) {
  figure = std::isnan(figure) ? value : std::max(figure, value);
}

Outcome fail(TrialResult& result, Outcome outcome, const std::string& why) {
  result.detail = why;
  return outcome;
}

}  // namespace

WorstEdge worst_edge(const Problem& problem, const Positions& x) {
  WorstEdge worst;
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    const auto [a, b] = problem.edges()[k];
    const double strain = std::abs((x.col(b) - x.col(a)).norm() / problem.rest_length()[k] - 1);
    if (!(strain <= worst.strain))
      worst = {std::isnan(strain) ? std::numeric_limits<double>::infinity() : strain, k};
  }
  return worst;
}

Witness::Witness(const Trial& trial, bool limit_promised)
    : trial_(trial),
      problem_(*trial.scene.problem),
      limit_promised_(limit_promised),
      mass_(problem_.total_mass()),
      free_(problem_.pinned().empty() && !problem_.collider()) {
  scale_ = mass_ * problem_.gravity().norm() * trial.scene.size +
           inextensible::kinetic_energy(problem_, trial.scene.start.v);
  judged_ = trial.energy_tolerance >= 0 && !trial.disturb && scale_ > 0;
  // What a start that violates the limit releases is known after the first step.
  if (worst_edge(problem_, trial.scene.start.x).strain <= trial.strain_limit)
    energy_ = energy(trial.scene.start);
}

void Witness::before(const State& state) {
  start_ = state;
  if (free_) momentum_ = momentum(problem_, state);
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
                    number_text(worst.strain));
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
    energy_ = energy(state);
    scale_ = std::max(scale_, *energy_);
    return {};
  }
  const double gain = (energy(state) - *energy_) / scale_;
  raise(result.energy_gain, gain);
  const double release = 0.5 * mass_ * std::pow(1.5 * trial_.slack / h, 2) / scale_;
  if (!(gain <= trial_.energy_tolerance + release))
    return fail(result, Outcome::wrong,
                "energy out of nothing, " + number_text(gain) + " of its scale");
  return {};
}

double Witness::energy(const State& state) const {
  return inextensible::potential_energy(problem_, state.x) +
         inextensible::kinetic_energy(problem_, state.v);
}

// |change of momentum - weight h| over what flows in the step; positions are known to rounding
// only.
double Witness::momentum_defect(const State& state, double h) const {
  const Eigen::Vector3d expected = momentum_ + h * mass_ * problem_.gravity();
  const double fastest = state.v.colwise().norm().maxCoeff() + start_.v.colwise().norm().maxCoeff();
  const double flow =
      mass_ * (fastest + h * problem_.gravity().norm()) + 1e-6 * mass_ * trial_.scene.size / h;
  return (momentum(problem_, state) - expected).norm() / flow;
}

}  // namespace harness
