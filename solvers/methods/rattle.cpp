// RATTLE (Andersen 1983): SHAKE's kin with velocities at the ends of steps. Second order,
// symmetric, hence without damping:
//   x^{n+1} = x^n + h v^n + h^2/2 (a(x^n) - W J(x^n)^T lambda)   with C(x^{n+1}) = 0  (SHAKE),
//   v^{n+1} = (x^{n+1} - x^n)/h + h/2 a(x^{n+1}) - W J(x^{n+1})^T nu   with J(x^{n+1}) v^{n+1} = 0.
// The matrix of the second line is the one that SHAKE needs in the next step: one factorization and
// two solves a step.

#include "solvers/methods/rows.h"
#include "solvers/methods/shake.h"
#include "solvers/problem/forces.h"
#include "solvers/problem/stopwatch.h"

namespace inextensible {
namespace {

class Rattle : public Stepper {
 public:
  Rattle(std::shared_ptr<const Problem> problem, const Shake::Settings& settings);
  const char* linear_solver() const override { return shake_.linear_solver(); }
  double reciprocal_condition() const override { return shake_.reciprocal_condition(); }

 protected:
  StepResult solve(const State& state, double h, Positions& x) override;
  StepResult end_velocities(const State& start, double h, const Positions& filtered,
                            const Positions& x, Positions& v) override;

 private:
  Shake shake_;
  Positions v_half_;  // with drag only
};

Rattle::Rattle(std::shared_ptr<const Problem> problem, const Shake::Settings& settings)
    : Stepper(std::move(problem)), shake_(*problem_, settings) {}

StepResult Rattle::solve(const State& state, double h, Positions& x) {
  Stopwatch stopwatch(phases_wanted_);
  x = state.x + h * state.v;  // position stage (Andersen 1983)
  add_acceleration(*problem_, state.x, 0.5 * h * h, x, work_);
  if (problem_->has_drag()) add_drag(*problem_, state.v, 0.5 * h * h, x);
  for (const int vertex : problem_->pinned()) x.col(vertex) = state.x.col(vertex);
  phases_.unconstrained += stopwatch();
  const StepResult result = apply_until_clear(shake_, contacts_inside(), state.x, h, x, work_);
  phases_.filter += stopwatch();
  return result;
}

StepResult Rattle::end_velocities(const State& start, double h, const Positions& /*filtered*/,
                                  const Positions& x, Positions& v) {
  Stopwatch stopwatch(phases_wanted_);
  v = (x - start.x) * (1 / h);  // velocity stage
  if (problem_->has_drag()) {   // of the velocity halfway
    v_half_ = v;
    add_drag(*problem_, v_half_, 0.5 * h, v);
  }
  add_acceleration(*problem_, x, 0.5 * h, v, work_);
  for (const int vertex : problem_->pinned())  // 0 unless pins follow a body
    v.col(vertex) = (x.col(vertex) - start.x.col(vertex)) * (1 / h);
  if (const Contacts* contacts = contacts_inside()) {  // which bear what presses on them
    for (int c = 0; c < contacts->count(); ++c) {
      const int vertex = contacts->vertex(c);
      if (contacts->holds(c)) v.col(vertex) = (x.col(vertex) - start.x.col(vertex)) * (1 / h);
    }
  }
  phases_.unconstrained += stopwatch();
  const StepResult result = shake_.project_velocity(x, contacts_inside(), v, work_);
  phases_.filter += stopwatch();
  return result;
}

}  // namespace

Backend rattle_row() {
  Shake::Settings defaults;
  defaults.min_iterations = 1;
  return {.name = "rattle",
          .summary =
              "SHAKE with velocities projected as well (Andersen 1983): second order, no damping",
          .strain_control = StrainControl::strain_limit,
          .contestant = true,
          .settings = setting_infos(Shake::fields(), defaults),
          .make = [](std::shared_ptr<const Problem> problem,
                     const BackendOptions& options) -> std::unique_ptr<Stepper> {
            return std::make_unique<Rattle>(std::move(problem), settings_of<Shake>(options));
          },
          .direction = Direction::start,
          .citation = "Andersen 1983",
          .origin = Origin::literature,
          .label = "RATTLE (SHAKE with velocities)",
          .family = "shake",
          .takes_implicit_forces = false,
          .velocities = Velocities::whole_step,
          .stepper = "verlet"};
}

}  // namespace inextensible
