#include "inextensible/stepping/velocity_filter.h"

#include "inextensible/problem/forces.h"
#include "inextensible/stepping/lap.h"

namespace inextensible {

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
