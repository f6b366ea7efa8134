#include "solvers/stepping/bdf2_stepper.h"

#include "solvers/problem/forces.h"
#include "solvers/problem/stopwatch.h"

namespace inextensible {

// y^{n+1} = now y^n + before y^{n-1} + beta_h y'^{n+1}; variable-step BDF2 (English and Bridson
// 2008 for constrained dynamics).
Bdf2Stepper::Coefficients Bdf2Stepper::coefficients(double h) const {
  const double w = h / h_before_, alpha = (1 + w) * (1 + w) / (1 + 2 * w);
  return {alpha, 1 - alpha, h * (1 + w) / (1 + 2 * w)};
}

Bdf2Stepper::Bdf2Stepper(std::shared_ptr<const Problem> problem,
                         std::unique_ptr<VelocityFilter> filter)
    : Stepper(std::move(problem)), filter_(std::move(filter)) {
  const Eigen::Index n = problem_->vertices();
  for (Positions* p : {&x_before_, &v_before_, &x_known_, &v_known_, &acceleration_})
    p->resize(3, n);
  if (problem_->shear() || !problem_->bending().empty() || problem_->implicit_forces())
    x_ahead_.resize(3, n);
  if (problem_->implicit_forces()) {
    implicit_ = std::make_unique<ImplicitForces>(*problem_);
    flight_velocity_.resize(3, n);
  }
}

void Bdf2Stepper::restart(const State& state, double h) {
  x_before_ = state.x - h * state.v + (0.5 * h * h) * acceleration_;
  v_before_ = state.v - h * acceleration_;
  x_known_ = state.x;
  v_known_ = state.v;
  h_before_ = h;
  ++restarts_;
}

StepResult Bdf2Stepper::solve(const State& state, double h, Positions& x) {
  Stopwatch stopwatch(phases_wanted_);
  if (problem_->pins_follow_body())  // they have moved since
    for (const int vertex : problem_->pinned()) x_known_.col(vertex) = state.x.col(vertex);
  const bool known = h_before_ > 0 && h <= largest_bdf2_growth * h_before_ && state.x == x_known_ &&
                     state.v == v_known_;
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
  if (!known) restart(state, h);
  const Coefficients c = coefficients(h);
  // In one pass: the formula for x with the formula for v in it.
  x = c.now * (state.x + c.beta_h * state.v) + c.before * (x_before_ + c.beta_h * v_before_) +
      (c.beta_h * c.beta_h) * acceleration_;
}

// The formulas without acceleration are the flight; what forces at its end add is (beta h)^2 a.
bool Bdf2Stepper::implicit_solve(const State& state, double h, bool known, Positions& x) {
  if (!known) {  // the present acceleration, as backward Euler sees it
    x = x_ahead_ = state.x + h * state.v;
    if (!implicit_->advance(h, state.v, x, work_)) return false;
    acceleration_ = (x - x_ahead_) / (h * h);
    restart(state, h);
  }
  const Coefficients c = coefficients(h);
  flight_velocity_ = c.now * state.v + c.before * v_before_;
  x_ahead_ = c.now * state.x + c.before * x_before_;
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
  const Coefficients c = coefficients(h);
  v = (x - c.now * start.x - c.before * x_before_) * (1 / c.beta_h);
  x_before_ = start.x;
  v_before_ = start.v;
  if (contacts_) {
    for (int contact = 0; contact < contacts_->count(); ++contact) {
      if (!contacts_->holds(contact)) continue;
      const int i = contacts_->vertex(contact);
      v.col(i) = (x.col(i) - start.x.col(i)) / h;
      x_before_.col(i) = x.col(i) - h * v.col(i) + (0.5 * h * h) * acceleration_.col(i);
      v_before_.col(i) = v.col(i) - h * acceleration_.col(i);
    }
  }
  for (const int vertex : problem_->pinned()) v.col(vertex).setZero();
  x_known_ = x;
  v_known_ = v;
  h_before_ = h;
  phases_.unconstrained += stopwatch();
  return {};
}

}  // namespace inextensible
