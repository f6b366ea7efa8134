#include "trial.h"

#include <chrono>
#include <cmath>
#include <optional>
#include <sstream>

#include "forces.h"
#include "registry.h"
#include "step_controller.h"

namespace harness {
namespace {

using inextensible::Positions;
using inextensible::Problem;
using inextensible::State;
using Clock = std::chrono::steady_clock;

constexpr double diverged_strain = 10;
constexpr double diverged_distance = 1e6;    // in scene sizes
constexpr double momentum_tolerance = 1e-8;  // of what flows in a step

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double total_mass(const Problem& problem) {
  double sum = 0;
  for (const double m : problem.mass()) sum += m;
  return sum;
}

Eigen::Vector3d momentum(const Problem& problem, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index v = 0; v < state.v.cols(); ++v)
    sum += problem.mass()[static_cast<std::size_t>(v)] * state.v.col(v);
  return sum;
}

struct WorstEdge {
  double strain = 0;
  std::size_t edge = 0;
};

WorstEdge worst_edge(const Problem& problem, const Positions& x) {
  WorstEdge worst;
  for (std::size_t k = 0; k < problem.edges().size(); ++k) {
    const auto [a, b] = problem.edges()[k];
    const double strain = std::abs((x.col(b) - x.col(a)).norm() / problem.rest_length()[k] - 1);
    if (!(strain <= worst.strain)) worst = {strain, k};
  }
  return worst;
}

// The checks of one attempt, step after step.
class Witness {
 public:
  Witness(const Trial& trial, bool limit_promised)
      : trial_(trial),
        problem_(*trial.scene.problem),
        limit_promised_(limit_promised),
        mass_(total_mass(problem_)),
        free_(problem_.pinned().empty() && !problem_.collider()) {
    scale_ = mass_ * problem_.gravity().norm() * trial.scene.size +
             inextensible::kinetic_energy(problem_, trial.scene.start.v);
    judged_ = trial.energy_tolerance >= 0 && !trial.disturb && scale_ > 0;
    // What a start that violates the limit releases is known after the first step.
    if (worst_edge(problem_, trial.scene.start.x).strain <= trial.strain_limit)
      energy_ = energy(trial.scene.start);
  }

  void before(const State& state) {
    start_ = state;
    if (free_) momentum_ = momentum(problem_, state);
  }

  // The outcome if the step tells one already.
  std::optional<Outcome> after(const Positions& filtered, const State& state, double h,
                               TrialResult& result) {
    if (!state.x.allFinite() || !state.v.allFinite())
      return fail(result, Outcome::wrong, "a state that is not finite was accepted");
    const WorstEdge worst = worst_edge(problem_, filtered);
    raise(result.max_strain, worst.strain);
    if (worst.strain > diverged_strain ||
        state.x.cwiseAbs().maxCoeff() > diverged_distance * trial_.scene.size)
      return fail(result, Outcome::diverged, "strain " + text(worst.strain));
    if (limit_promised_ && worst.strain > trial_.strain_limit * (1 + 1e-9)) {
      return fail(result, Outcome::wrong,
                  "success claimed, but edge " + std::to_string(worst.edge) + " is strained by " +
                      text(worst.strain));
    }
    for (const int pin : problem_.pinned()) {
      if (state.x.col(pin) != start_.x.col(pin))
        return fail(result, Outcome::wrong, "pinned vertex " + std::to_string(pin) + " moved");
    }
    if (free_) {
      const Eigen::Vector3d expected = momentum_ + h * mass_ * problem_.gravity();
      const double flow =
          mass_ * (state.v.colwise().norm().maxCoeff() + start_.v.colwise().norm().maxCoeff() +
                   h * problem_.gravity().norm()) +
          1e-6 * mass_ * trial_.scene.size / h;
      const double defect = (momentum(problem_, state) - expected).norm() / flow;
      raise(result.momentum_defect, defect);
      if (!(defect <= momentum_tolerance))
        return fail(result, Outcome::wrong, "momentum is not conserved, by " + text(defect));
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
      return fail(result, Outcome::wrong, "energy out of nothing, " + text(gain) + " of its scale");
    return {};
  }

 private:
  static std::string text(double value) {
    std::ostringstream stream;
    stream << value;
    return stream.str();
  }
  static void raise(double& figure, double value) {
    figure = std::isnan(figure) ? value : std::max(figure, value);
  }
  static Outcome fail(TrialResult& result, Outcome outcome, const std::string& why) {
    result.detail = why;
    return outcome;
  }
  double energy(const State& state) const {
    return inextensible::potential_energy(problem_, state.x) +
           inextensible::kinetic_energy(problem_, state.v);
  }

  const Trial& trial_;
  const Problem& problem_;
  bool limit_promised_;
  double mass_;
  bool free_, judged_ = false;
  double scale_;
  std::optional<double> energy_;  // what it is judged against
  State start_;
  Eigen::Vector3d momentum_ = Eigen::Vector3d::Zero();
};

// One attempt, with or without the step controller.
Outcome attempt(const Trial& trial, const inextensible::Backend& backend, std::uint64_t seed,
                bool controlled, TrialResult& result) {
  const auto begin = Clock::now();
  inextensible::check_state(*trial.scene.problem, trial.scene.start);
  const auto settings = trial.settings.find(backend.name);
  const auto stepper = inextensible::make_stepper(
      backend.name, trial.scene.problem,
      {trial.strain_limit, seed,
       settings == trial.settings.end() ? inextensible::Settings{} : settings->second});
  inextensible::StepController controller(
      *stepper, {.largest = trial.step, .most_halvings = controlled ? 10 : 0});
  State state = trial.scene.start;
  Witness witness(trial, backend.knob == inextensible::Knob::strain_limit);
  std::optional<Outcome> outcome;
  for (int i = 0; i < trial.steps && !outcome;) {
    if (trial.disturb && controller.aligned()) trial.disturb(state, i);
    witness.before(state);
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
    outcome = witness.after(stepper->filtered_positions(), state, controller.last(), result);
    if (controller.aligned()) ++i;
    if (!outcome && i < trial.steps && since(begin) > trial.timeout) {
      result.detail = "stopped after " + std::to_string(stepper->work().steps) + " steps";
      outcome = Outcome::timeout;
    }
  }
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
