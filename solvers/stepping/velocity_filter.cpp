#include "solvers/stepping/velocity_filter.h"

namespace inextensible {

// Limit on rounds. Of a convex obstacle every vertex is found once at most.
constexpr int most_rounds = 30;
// The start is feasible, but for what the obstacle moves. So the feasible point closest to the
// candidate is no farther from it than the start is, hence at most twice as far from the start as
// the candidate (triangle inequality). Inexact methods get another factor of 2. What is farther is
// a spurious solution, and would add energy.
constexpr double farthest = 4;

StepResult apply_until_clear(VelocityFilter& filter, Contacts* contacts, const Positions& x_start,
                             double h, Positions& x, WorkCounters& work) {
  if (!contacts) return filter.apply(x_start, h, {x, contacts}, work);
  contacts->apply_friction(x, work);
  contacts->find(x, work);
  const double reach = farthest * contacts->distance(x) + contacts->slack();
  for (int round = 0, iterations = 0;; ++round) {
    contacts->settle(x);
    StepResult result = filter.apply(x_start, h, {x, contacts}, work);
    result.iterations = iterations += result.iterations;
    if (!result) return result;
    if (contacts->count() > 0 && !(contacts->distance(x) <= reach))
      return {Status::not_converged, iterations, -1, 0, "a spurious solution, far from the start"};
    if (contacts->find(x, work) == 0) {
      contacts->set_clear();
      return result;
    }
    if (round == most_rounds)
      return {Status::not_converged, iterations, -1, 0, "the contact set did not settle"};
  }
}

FilterStepper::FilterStepper(std::shared_ptr<const Problem> problem,
                             std::unique_ptr<VelocityFilter> filter)
    : Stepper(std::move(problem)), filter_(std::move(filter)) {
  if (problem_->implicit_forces()) implicit_ = std::make_unique<ImplicitForces>(*problem_);
}

bool FilterStepper::unconstrained(const State& state, double h, Positions& x0) {
  return unconstrained_step(*problem_, in_step(implicit_, h), state, h, x0, work_);
}

StepResult FilterStepper::solve(const State& state, double h, Positions& x) {
  Stopwatch stopwatch(phases_wanted_);
  if (!unconstrained(state, h, x)) return {Status::singular, 0, -1, 0, singular_forces};
  phases_.unconstrained += stopwatch();
  const StepResult result =
      apply_until_clear(*filter_, contacts_inside(), start_positions(), h, x, work_);
  phases_.filter += stopwatch();
  return result;
}

}  // namespace inextensible
