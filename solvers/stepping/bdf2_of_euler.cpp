#include "solvers/stepping/bdf2_of_euler.h"

namespace inextensible {

Bdf2OfEuler::Bdf2OfEuler(std::shared_ptr<const Problem> problem, std::unique_ptr<Stepper> euler)
    : Stepper(std::move(problem), ContactsElsewhere{}),
      euler_(std::move(euler)),
      history_(*problem_),
      gravity_(problem_->gravity().replicate(1, problem_->vertices())) {
  for (Positions* p : {&ahead_.x, &ahead_.v}) p->resize(3, problem_->vertices());
}

StepResult Bdf2OfEuler::solve(const State& state, double h, Positions& x) {
  const auto& pinned = problem_->pinned();
  if (!history_.leads_to(state, h)) history_.restart(state, h, gravity_);
  const auto [now, before, beta_h] = history_.coefficients(h);
  ahead_.x = now * state.x + before * history_.x();
  ahead_.v = now * state.v + before * history_.v();
  ahead_.time = state.time + (h - beta_h);
  for (const int vertex : pinned) {
    ahead_.x.col(vertex) = start_positions().col(vertex);
    ahead_.v.col(vertex).setZero();
  }
  if (problem_->pins_follow_body()) {
    const BodyMotion& motion = problem_->body_motion();
    const Pose carry = motion(ahead_.time) * motion(state.time).inverse();
    for (const int vertex : pinned) ahead_.x.col(vertex) = carry(ahead_.x.col(vertex));
  }
  euler_->measure_phases(phases_wanted_);
  const StepResult result = euler_->advance(ahead_, beta_h);
  phases_ = euler_->phases();
  const WorkCounters own = work_;  // steps are those of the pair
  work_ = euler_->work();
  work_.steps = own.steps;
  work_.rejected_steps = own.rejected_steps;
  work_.iterations = own.iterations;
  x = ahead_.x;
  return result;
}

StepResult Bdf2OfEuler::end_velocities(const State& start, double h, const Positions& /*filtered*/,
                                       const Positions& x, Positions& v) {
  v = ahead_.v;
  history_.add_step(start, h, x, gravity_, euler_->contacts(), v);
  return {};
}

}  // namespace inextensible
