// RATTLE (Andersen 1983): SHAKE's kin with velocities at the ends of steps. Second order,
// symmetric, hence without damping:
//   x^{n+1} = x^n + h v^n + h^2/2 (a(x^n) - W J(x^n)^T lambda)   with C(x^{n+1}) = 0  (SHAKE),
//   v^{n+1} = (x^{n+1} - x^n)/h + h/2 a(x^{n+1}) - W J(x^{n+1})^T nu   with J(x^{n+1}) v^{n+1} = 0.
// The matrix of the second line is the one that SHAKE needs in the next step: one factorization and
// two solves a step.
#pragma once

#include "solvers/methods/shake.h"

namespace inextensible {

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

Backend rattle_row();

}  // namespace inextensible
