#include "solvers/stepping/stepper.h"

namespace inextensible {

Stepper::Stepper(std::shared_ptr<const Problem> problem, bool own_contacts)
    : problem_(std::move(problem)),
      next_(3, problem_->vertices()),
      velocity_(3, problem_->vertices()) {
  if (!own_contacts || !problem_->collider()) return;
  contacts_ = std::make_unique<Contacts>(*problem_);
  filtered_.resize(3, problem_->vertices());
}

void Stepper::measure_phases(bool wanted) {
  phases_wanted_ = wanted;
  if (contacts_) contacts_->measure(wanted ? &phases_.contact : nullptr);
}

StepResult Stepper::advance(State& state, double h) {
  const StepResult result = attempt(state, h);
  ++(result ? work_.steps : work_.rejected_steps);
  return result;
}

StepResult Stepper::attempt(State& state, double h) {
  if (!(h > 0) || !std::isnormal(h))
    return {Status::not_finite, 0, -1, 0, "the step must be a positive, finite time"};
  if (contacts_) contacts_->begin(state.x, state.time, h);
  start_ = &state.x;
  const StepResult result = solve(with_pins_at_end(state, h), h, next_);
  work_.iterations += result.iterations;
  if (!result) return result;
  if (contacts_ && !contacts_->clear()) {
    Stopwatch stopwatch(phases_wanted_);
    filtered_ = next_;
    const Contacts::Timing measured = contacts_->timing();
    contacts_->push_out(next_, work_);
    phases_.collision += stopwatch();
  }
  // A sum is not finite if any term is not.
  if (!std::isfinite(next_.sum()))
    return {Status::not_finite, result.iterations, -1, 0, "a position overflowed"};
  const StepResult end = end_velocities(state, h, next_, velocity_);
  if (!end) return end;
  if (!std::isfinite(velocity_.sum()))
    return {Status::not_finite, result.iterations, -1, 0, "a velocity overflowed"};
  if (contacts_) contacts_->accept(filtered_positions());
  state.v.swap(velocity_);
  state.x = next_;
  state.time += h;
  return result;
}

const State& Stepper::with_pins_at_end(const State& state, double h) {
  if (!problem_->pins_follow_body()) return state;
  const BodyMotion& motion = problem_->body_motion();
  const Pose carry = motion(state.time + h) * motion(state.time).inverse();
  moved_ = state;
  for (const int vertex : problem_->pinned()) {
    moved_.x.col(vertex) = carry(state.x.col(vertex));
    moved_.v.col(vertex).setZero();
  }
  return moved_;
}

StepResult Stepper::end_velocities(const State& start, double h, const Positions& x, Positions& v) {
  v = (x - start.x) * (1 / h);
  return {};
}

}  // namespace inextensible
