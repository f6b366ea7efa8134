#include "solvers/stepping/bdf2_stepper.h"

#include "solvers/problem/forces.h"
#include "solvers/problem/stopwatch.h"

namespace inextensible {

Bdf2Stepper::Bdf2Stepper(std::shared_ptr<const Problem> problem,
                         std::unique_ptr<VelocityFilter> filter)
    : Stepper(std::move(problem)),
      filter_(std::move(filter)),
      history_(*problem_),
      acceleration_(3, problem_->vertices()) {
  const Eigen::Index n = problem_->vertices();
  if (problem_->shear() || !problem_->bending().empty() || problem_->implicit_forces())
    x_ahead_.resize(3, n);
  if (problem_->implicit_forces()) {
    implicit_ = std::make_unique<ImplicitForces>(*problem_);
    flight_velocity_.resize(3, n);
  }
}

StepResult Bdf2Stepper::solve(const State& state, double h, Positions& x) {
  Stopwatch stopwatch(phases_wanted_);
  const bool known = history_.leads_to(state, h);
  if (implicit_) {
    if (!implicit_solve(state, h, known, x)) return no_forces();
  } else {
    explicit_solve(state, h, known, x);
  }
  for (const int vertex : problem_->pinned()) x.col(vertex) = state.x.col(vertex);
  phases_.unconstrained += stopwatch();
  const StepResult result =
      apply_until_clear(*filter_, contacts_inside(), start_positions(), h, x, work_);
  phases_.filter += stopwatch();
  return result;
}

void Bdf2Stepper::explicit_solve(const State& state, double h, bool known, Positions& x) {
  acceleration_.setZero();
  if (x_ahead_.cols() > 0) x_ahead_ = state.x + h * state.v;
  add_acceleration(*problem_, x_ahead_, 1, acceleration_, work_);
  if (problem_->has_drag()) add_drag(*problem_, state.v, 1, acceleration_);
  for (const int vertex : problem_->pinned()) acceleration_.col(vertex).setZero();
  if (!known) history_.restart(state, h, acceleration_);
  const Bdf2Coefficients c = history_.coefficients(h);
  // In one pass: the formula for x with the formula for v in it.
  x = c.now * (state.x + c.beta_h * state.v) + c.before * (history_.x() + c.beta_h * history_.v()) +
      (c.beta_h * c.beta_h) * acceleration_;
}

// The formulas without acceleration are the flight; what forces at its end add is (beta h)^2 a.
bool Bdf2Stepper::implicit_solve(const State& state, double h, bool known, Positions& x) {
  if (!known) {  // the present acceleration, as backward Euler sees it
    x = x_ahead_ = state.x + h * state.v;
    if (!implicit_->advance(h, state.v, x, work_)) return false;
    acceleration_ = (x - x_ahead_) / (h * h);
    history_.restart(state, h, acceleration_);
  }
  const Bdf2Coefficients c = history_.coefficients(h);
  flight_velocity_ = c.now * state.v + c.before * history_.v();
  x_ahead_ = c.now * state.x + c.before * history_.x();
  x_ahead_ += c.beta_h * flight_velocity_;
  if (problem_->pins_follow_body())
    for (const int vertex : problem_->pinned()) x_ahead_.col(vertex) = state.x.col(vertex);
  x = x_ahead_;
  if (!implicit_->advance(c.beta_h, flight_velocity_, x, work_)) return false;
  acceleration_ = (x - x_ahead_) / (c.beta_h * c.beta_h);
  return true;
}

StepResult Bdf2Stepper::end_velocities(const State& start, double h, const Positions& /*filtered*/,
                                       const Positions& x, Positions& v) {
  Stopwatch stopwatch(phases_wanted_);
  const Bdf2Coefficients c = history_.coefficients(h);
  v = (x - c.now * start.x - c.before * history_.x()) * (1 / c.beta_h);
  history_.add_step(start, h, x, acceleration_, contacts_.get(), v);
  phases_.unconstrained += stopwatch();
  return {};
}

}  // namespace inextensible
