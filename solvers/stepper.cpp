#include "stepper.h"

#include <chrono>
#include <cmath>

#include "forces.h"

namespace inextensible {
namespace {

class Lap {
 public:
  // Seconds since construction or the last call.
  double operator()() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

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
    : problem_(std::move(problem)), next_(3, problem_->vertices()) {
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
    Lap lap;
    filtered_ = next_;
    collider->resolve(state.x, problem_->inverse_mass(), next_, work_);
    phases_.collision += lap();
  }
  // One pass over all numbers commits the step; a sum is not finite if any term is not.
  const double inverse_h = 1 / h;
  const double total = next_.sum();
  if (!std::isfinite(total)) {
    ++work_.rejected_steps;
    return {Status::not_finite, result.iterations, -1, 0, "a position overflowed"};
  }
  state.v = (next_ - state.x) * inverse_h;
  state.x = next_;
  state.time += h;
  ++work_.steps;
  return result;
}

FilterStepper::FilterStepper(std::shared_ptr<const Problem> problem,
                             std::unique_ptr<VelocityFilter> filter)
    : Stepper(std::move(problem)), filter_(std::move(filter)) {}

StepResult FilterStepper::solve(const State& state, double h, Positions& x) {
  Lap lap;
  unconstrained_step(*problem_, state, h, x, work_);
  phases_.unconstrained += lap();
  const StepResult result = filter_->apply(state.x, h, x, work_);
  phases_.filter += lap();
  return result;
}

}  // namespace inextensible
