#include "solvers/stepping/bdf2_of_euler.h"

#include "solvers/stepping/bdf2_stepper.h"

namespace inextensible {

Bdf2OfEuler::Bdf2OfEuler(std::shared_ptr<const Problem> problem, std::unique_ptr<Stepper> euler)
    : Stepper(std::move(problem), ContactsElsewhere{}), euler_(std::move(euler)) {
  for (Positions* p : {&ahead_.x, &ahead_.v, &x_before_, &v_before_, &x_known_, &v_known_})
    p->resize(3, problem_->vertices());
}

void Bdf2OfEuler::restart(const State& state, double h) {
  const Eigen::Vector3d gravity = problem_->gravity();
  x_before_ = state.x - h * state.v;
  x_before_.colwise() += Eigen::Vector3d(0.5 * h * h * gravity);
  v_before_ = state.v;
  v_before_.colwise() -= Eigen::Vector3d(h * gravity);
  x_known_ = state.x;
  v_known_ = state.v;
  h_before_ = h;
}

StepResult Bdf2OfEuler::solve(const State& state, double h, Positions& x) {
  const auto& pinned = problem_->pinned();
  for (const int vertex : pinned) x_known_.col(vertex) = state.x.col(vertex);  // may have moved
  if (!(h_before_ > 0) || h > largest_bdf2_growth * h_before_ || state.x != x_known_ ||
      state.v != v_known_)
    restart(state, h);
  const double w = h / h_before_;
  const double alpha = (1 + w) * (1 + w) / (1 + 2 * w), beta_h = h * (1 + w) / (1 + 2 * w);
  ahead_.x = alpha * state.x + (1 - alpha) * x_before_;
  ahead_.v = alpha * state.v + (1 - alpha) * v_before_;
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
  x_before_ = start.x;
  v_before_ = start.v;
  if (const Contacts* contacts = euler_->contacts()) {
    const Eigen::Vector3d gravity = problem_->gravity();
    for (int contact = 0; contact < contacts->count(); ++contact) {
      if (!contacts->holds(contact)) continue;
      const int i = contacts->vertex(contact);
      v.col(i) = (x.col(i) - start.x.col(i)) / h;
      x_before_.col(i) = x.col(i) - h * v.col(i) + (0.5 * h * h) * gravity;
      v_before_.col(i) = v.col(i) - h * gravity;
    }
  }
  for (const int vertex : problem_->pinned()) v.col(vertex).setZero();
  x_known_ = x;
  v_known_ = v;
  h_before_ = h;
  return {};
}

}  // namespace inextensible
