#include "inextensible/stepping/velocity_filter.h"

#include "inextensible/problem/forces.h"
#include "inextensible/stepping/lap.h"

namespace inextensible {

FilterStepper::FilterStepper(std::shared_ptr<const Problem> problem,
                             std::unique_ptr<VelocityFilter> filter)
    : Stepper(std::move(problem)), filter_(std::move(filter)) {
  if (problem_->implicit_forces()) implicit_ = std::make_unique<ImplicitForces>(*problem_);
}

StepResult no_forces() {
  return {Status::singular, 0, -1, 0, "the system of implicit forces is singular"};
}

StepResult FilterStepper::solve(const State& state, double h, Positions& x) {
  Lap lap(phases_wanted_);
  if (implicit_) {
    x = state.x + h * state.v;
    for (const int vertex : problem_->pinned()) x.col(vertex) = state.x.col(vertex);
    if (!implicit_->advance(h, state.v, x, work_)) return no_forces();
  } else {
    unconstrained_step(*problem_, state, h, x, work_);
  }
  phases_.unconstrained += lap();
  const StepResult result = filter_->apply(state.x, h, x, work_);
  phases_.filter += lap();
  return result;
}

}  // namespace inextensible
