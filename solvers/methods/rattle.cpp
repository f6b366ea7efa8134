#include "inextensible/methods/rattle.h"

#include "inextensible/problem/forces.h"
#include "inextensible/stepping/lap.h"

namespace inextensible {

Rattle::Rattle(std::shared_ptr<const Problem> problem, const Shake::Settings& settings)
    : Stepper(std::move(problem)), shake_(*problem_, settings) {}

StepResult Rattle::solve(const State& state, double h, Positions& x) {
  Lap lap(phases_wanted_);
  x = state.x + h * state.v;
  add_acceleration(*problem_, state.x, 0.5 * h * h, x, work_);
  for (const int vertex : problem_->pinned()) x.col(vertex) = state.x.col(vertex);
  phases_.unconstrained += lap();
  const StepResult result = shake_.apply(state.x, h, x, work_);
  phases_.filter += lap();
  return result;
}

StepResult Rattle::end_velocities(const State& start, double h, const Positions& /*filtered*/,
                                  const Positions& x, Positions& v) {
  Lap lap(phases_wanted_);
  v = (x - start.x) * (1 / h);
  add_acceleration(*problem_, x, 0.5 * h, v, work_);
  for (const int vertex : problem_->pinned()) v.col(vertex).setZero();
  phases_.unconstrained += lap();
  const StepResult result = shake_.project_velocity(x, v, work_);
  phases_.filter += lap();
  return result;
}

}  // namespace inextensible
