#include "solvers/methods/rattle_suzuki.h"

#include <cmath>

namespace inextensible {

RattleSuzuki::RattleSuzuki(std::shared_ptr<const Problem> problem, const Shake::Settings& settings)
    : Rattle(std::move(problem), settings), next_(3, problem_->vertices()) {
  velocity_ = next_;
}

StepResult RattleSuzuki::solve(const State& state, double h, Positions& x) {
  const double s = 1 / (4 - std::cbrt(4.0));  // Suzuki 1990
  StepResult whole;
  now_ = state;
  for (const double part : {s, s, 1 - 4 * s, s, s}) {
    StepResult result = Rattle::solve(now_, part * h, next_);
    result.iterations = whole.iterations += result.iterations;
    if (!result) return result;
    if (const StepResult end = Rattle::end_velocities(now_, part * h, next_, next_, velocity_);
        !end)
      return end;
    now_.x.swap(next_);
    now_.v.swap(velocity_);
  }
  x = now_.x;
  return whole;
}

StepResult RattleSuzuki::end_velocities(const State& /*start*/, double /*h*/,
                                        const Positions& /*filtered*/, const Positions& /*x*/,
                                        Positions& v) {
  v = now_.v;
  return {};
}

Backend rattle_suzuki_row() {
  Backend row = rattle_row();
  row.name = "rattle_suzuki";
  row.summary = "five steps of RATTLE, one of them backwards: fourth order, no damping";
  row.contestant = false;
  Shake::Settings defaults;
  // Constraint errors must be as small as those of the fourth order.
  defaults.min_iterations = 3;
  row.settings = setting_infos(Shake::fields(), defaults);
  row.make = [](std::shared_ptr<const Problem> problem,
                const BackendOptions& options) -> std::unique_ptr<Stepper> {
    return std::make_unique<RattleSuzuki>(std::move(problem), settings_of<Shake>(options));
  };
  row.citation = "Andersen 1983; Suzuki 1990; Reich 1996";
  row.label = "RATTLE composed to order 4";
  row.takes_collider = row.takes_drag = false;
  return row;
}

}  // namespace inextensible
