#include "bdf2_stepper.h"

#include "forces.h"
#include "lap.h"

namespace inextensible {
namespace {

constexpr double largest_growth = 2;  // of the step; variable-step BDF2 is stable below 1 + sqrt 2

struct Coefficients {
  Coefficients(double h, double h_before)
      : w(h / h_before),
        alpha((1 + w) * (1 + w) / (1 + 2 * w)),
        beta_h(h * (1 + w) / (1 + 2 * w)) {}
  double w, alpha, beta_h;
};

}  // namespace

Bdf2Stepper::Bdf2Stepper(std::shared_ptr<const Problem> problem,
                         std::unique_ptr<VelocityFilter> filter)
    : Stepper(std::move(problem)), filter_(std::move(filter)) {
  const Eigen::Index n = problem_->vertices();
  for (Positions* p : {&x_before_, &v_before_, &x_known_, &v_known_, &acceleration_})
    p->resize(3, n);
  if (problem_->shear()) x_ahead_.resize(3, n);
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
  Lap lap;
  acceleration_.setZero();
  if (problem_->shear()) x_ahead_ = state.x + h * state.v;
  add_acceleration(*problem_, x_ahead_, 1, acceleration_, work_);
  for (const int vertex : problem_->pinned()) acceleration_.col(vertex).setZero();
  const bool known = h_before_ > 0 && h <= largest_growth * h_before_ && state.x == x_known_ &&
                     state.v == v_known_;
  if (!known) restart(state, h);
  const Coefficients c(h, h_before_);
  // In one pass: x0 = alpha x^n + (1 - alpha) x^{n-1} + beta h (alpha v^n + (1 - alpha) v^{n-1} +
  // beta h a)
  x = c.alpha * (state.x + c.beta_h * state.v) +
      (1 - c.alpha) * (x_before_ + c.beta_h * v_before_) + (c.beta_h * c.beta_h) * acceleration_;
  for (const int vertex : problem_->pinned()) x.col(vertex) = state.x.col(vertex);
  phases_.unconstrained += lap();
  const StepResult result = filter_->apply(state.x, h, x, work_);
  phases_.filter += lap();
  return result;
}

StepResult Bdf2Stepper::end_velocities(const State& start, double h, const Positions& filtered,
                                       const Positions& x, Positions& v) {
  Lap lap;
  const Coefficients c(h, h_before_);
  v = (x - c.alpha * start.x - (1 - c.alpha) * x_before_) * (1 / c.beta_h);
  x_before_ = start.x;
  v_before_ = start.v;
  if (problem_->collider()) {
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      if (x.col(i) == filtered.col(i)) continue;
      v.col(i) = (x.col(i) - start.x.col(i)) / h;
      x_before_.col(i) = x.col(i) - h * v.col(i) + (0.5 * h * h) * acceleration_.col(i);
      v_before_.col(i) = v.col(i) - h * acceleration_.col(i);
    }
  }
  for (const int vertex : problem_->pinned()) v.col(vertex).setZero();
  x_known_ = x;
  v_known_ = v;
  h_before_ = h;
  phases_.unconstrained += lap();
  return {};
}

}  // namespace inextensible
