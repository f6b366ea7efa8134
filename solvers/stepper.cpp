#include "stepper.h"

#include <cmath>

#include "forces.h"
#include "lap.h"

namespace inextensible {
const char* to_string(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::not_converged:
      return "not_converged";
    case Status::singular:
      return "singular";
    case Status::not_finite:
      return "not_finite";
  }
  return "?";
}

Stepper::Stepper(std::shared_ptr<const Problem> problem)
    : problem_(std::move(problem)),
      next_(3, problem_->vertices()),
      velocity_(3, problem_->vertices()) {
  if (problem_->collider()) filtered_.resize(3, problem_->vertices());
}

StepResult Stepper::advance(State& state, double h) {
  StepResult result = solve(state, h, next_);
  work_.iterations += result.iterations;
  if (!result) {
    ++work_.rejected_steps;
    return result;
  }
  if (const Collider* collider = problem_->collider()) {
    Lap lap(phases_wanted_);
    filtered_ = next_;
    collider->resolve(state.x, problem_->inverse_mass(), next_, work_);
    phases_.collision += lap();
  }
  // A sum is not finite if any term is not.
  if (!std::isfinite(next_.sum())) {
    ++work_.rejected_steps;
    return {Status::not_finite, result.iterations, -1, 0, "a position overflowed"};
  }
  const StepResult end = end_velocities(state, h, filtered_positions(), next_, velocity_);
  if (!end) {
    ++work_.rejected_steps;
    return end;
  }
  state.v.swap(velocity_);
  state.x = next_;
  state.time += h;
  ++work_.steps;
  return result;
}

StepResult Stepper::end_velocities(const State& start, double h, const Positions& /*filtered*/,
                                   const Positions& x, Positions& v) {
  v = (x - start.x) * (1 / h);
  return {};
}

FilterStepper::FilterStepper(std::shared_ptr<const Problem> problem,
                             std::unique_ptr<VelocityFilter> filter)
    : Stepper(std::move(problem)), filter_(std::move(filter)) {}

StepResult FilterStepper::solve(const State& state, double h, Positions& x) {
  Lap lap(phases_wanted_);
  unconstrained_step(*problem_, state, h, x, work_);
  phases_.unconstrained += lap();
  const StepResult result = filter_->apply(state.x, h, x, work_);
  phases_.filter += lap();
  return result;
}

}  // namespace inextensible
