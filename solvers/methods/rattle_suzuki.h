// RATTLE composed to fourth order: five of its steps, of
//   s h, s h, (1 - 4 s) h, s h, s h   with s = 1 / (4 - 4^(1/3)),
// the middle one backwards in time, make one step of a symmetric method of order 2 one of order 4
// (Suzuki 1990; of constrained systems Reich 1996). For motion that nothing damps and nothing
// stops: what cannot be run backwards is not taken.
#pragma once

#include "solvers/methods/rattle.h"

namespace inextensible {

class RattleSuzuki final : public Rattle {
 public:
  RattleSuzuki(std::shared_ptr<const Problem> problem, const Shake::Settings& settings);

 private:
  StepResult solve(const State& state, double h, Positions& x) override;
  StepResult end_velocities(const State& start, double h, const Positions& filtered,
                            const Positions& x, Positions& v) override;

  State now_;  // between the five
  Positions next_, velocity_;
};

Backend rattle_suzuki_row();

}  // namespace inextensible
