#include "solvers/stepping/bdf2.h"

#include "solvers/problem/forces.h"

namespace inextensible {

constexpr double largest_growth = 2;  // the formula is stable below 1 + sqrt 2

Bdf2History::Bdf2History(const Problem& problem) : problem_(problem) {
  for (Positions* p : {&x_, &v_, &x_known_, &v_known_}) p->resize(3, problem.vertices());
}

bool Bdf2History::leads_to(const State& state, double h) {
  if (problem_.pins_follow_body())
    for (const int vertex : problem_.pinned()) x_known_.col(vertex) = state.x.col(vertex);
  return h_ > 0 && h <= largest_growth * h_ && state.x == x_known_ && state.v == v_known_;
}

void Bdf2History::restart(const State& state, double h, const Positions& acceleration) {
  x_ = state.x - h * state.v + (0.5 * h * h) * acceleration;
  v_ = state.v - h * acceleration;
  h_ = h;
}

Bdf2Coefficients Bdf2History::coefficients(double h) const {
  const double w = h / h_, alpha = (1 + w) * (1 + w) / (1 + 2 * w);
  return {alpha, 1 - alpha, h * (1 + w) / (1 + 2 * w)};
}

void Bdf2History::add_step(const State& start, double h, const Positions& x,
                           const Contacts* contacts, Positions& v) {
  x_ = start.x;
  v_ = start.v;
  for (int contact = 0; contacts && contact < contacts->count(); ++contact) {
    if (!contacts->holds(contact)) continue;
    const int i = contacts->vertex(contact);
    const Eigen::Vector3d& n = contacts->normal(contact);
    const Eigen::Vector3d mean = (x.col(i) - start.x.col(i)) / h;
    v.col(i) = contacts->end_velocity(contact, mean, v.col(i));
    if (contacts->stopped(contact)) {
      x_.col(i) = start.x.col(i);
      v_.col(i) = mean;
    } else {
      x_.col(i) += n.dot(x.col(i) - h * v.col(i) - x_.col(i)) * n;
      v_.col(i) += n.dot(v.col(i) - v_.col(i)) * n;
    }
  }
  for (const int vertex : problem_.pinned()) v.col(vertex).setZero();
  x_known_ = x;
  v_known_ = v;
  h_ = h;
}

Bdf2Stepper::Bdf2Stepper(std::shared_ptr<const Problem> problem,
                         std::unique_ptr<VelocityFilter> filter)
    : FilterStepper(std::move(problem), std::move(filter)),
      history_(*problem_),
      acceleration_(3, problem_->vertices()) {
  const Eigen::Index n = problem_->vertices();
  if (problem_->shear() || !problem_->bending().empty() || problem_->implicit_forces())
    x_ahead_.resize(3, n);
  if (implicit_) flight_velocity_.resize(3, n);
}

bool Bdf2Stepper::unconstrained(const State& state, double h, Positions& x) {
  const bool known = history_.leads_to(state, h);
  if (!in_step(implicit_, h))
    explicit_solve(state, h, known, x);
  else if (!implicit_solve(state, h, known, x))
    return false;
  for (const int vertex : problem_->pinned()) x.col(vertex) = state.x.col(vertex);
  return true;
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
    if (!implicit_->advance(state, h, h, h, state.v, x, work_)) return false;
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
  if (!implicit_->advance(state, h, c.beta_h, h, flight_velocity_, x, work_)) return false;
  acceleration_ = (x - x_ahead_) / (c.beta_h * c.beta_h);
  return true;
}

StepResult Bdf2Stepper::end_velocities(const State& start, double h, const Positions& x,
                                       Positions& v) {
  Stopwatch stopwatch(phases_wanted_);
  const Bdf2Coefficients c = history_.coefficients(h);
  v = (x - c.now * start.x - c.before * history_.x()) * (1 / c.beta_h);
  history_.add_step(start, h, x, contacts_.get(), v);
  phases_.unconstrained += stopwatch();
  return {};
}

}  // namespace inextensible
