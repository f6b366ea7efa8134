#include "solvers/stepping/midpoint_stepper.h"

#include "solvers/problem/forces.h"
#include "solvers/problem/stopwatch.h"

namespace inextensible {

MidpointStepper::MidpointStepper(std::shared_ptr<const Problem> problem,
                                 std::unique_ptr<VelocityFilter> filter, double spectral_radius)
    : FilterStepper(std::move(problem), std::move(filter)),
      rho_(spectral_radius),
      middle_(3, problem_->vertices()),
      candidate_(3, problem_->vertices()) {}

bool MidpointStepper::unconstrained(const State& state, double h, Positions& x0) {
  if (ImplicitForces* forces = in_step(implicit_, h)) {
    x0 = state.x + h * state.v;
    x0.colwise() += 0.5 * h * h * problem_->gravity();
    for (const int vertex : problem_->pinned()) x0.col(vertex) = state.x.col(vertex);
    candidate_ = x0;
    return forces->advance_inside(state, h, 1 / (1 + rho_), x0, work_);
  }
  const double scale = 0.5 * h * h;
  x0 = state.x + h * state.v;
  middle_ = 0.5 * (state.x + x0);
  add_acceleration(*problem_, middle_, scale, x0, work_);
  if (problem_->has_drag()) add_drag(*problem_, state.v, scale, x0);
  for (const int vertex : problem_->pinned()) x0.col(vertex) = state.x.col(vertex);
  candidate_ = x0;
  return true;
}

StepResult MidpointStepper::end_velocities(const State& start, double h, const Positions& x,
                                           Positions& v) {
  Stopwatch stopwatch(phases_wanted_);
  v = (2 * (candidate_ - start.x) + (1 + rho_) * (x - candidate_)) * (1 / h) - start.v;
  if (contacts_) {
    // Friction is a force of the candidate's, and no constraint's.
    const bool friction = contacts_->candidate().size() > 0;
    for (int contact = 0; contact < contacts_->count(); ++contact) {
      if (!contacts_->holds(contact)) continue;
      const int i = contacts_->vertex(contact);
      if (friction)
        v.col(i) += (1 - rho_) / h * (contacts_->candidate().col(i) - candidate_.col(i));
      v.col(i) =
          contacts_->end_velocity(contact, x.col(i), (x.col(i) - start.x.col(i)) / h, v.col(i));
    }
  }
  for (const int vertex : problem_->pinned()) v.col(vertex).setZero();
  phases_.unconstrained += stopwatch();
  return {};
}

}  // namespace inextensible
