// BDF2 around a method that is a backward Euler step of its own. With w = h / h_{n-1},
//   alpha = (1 + w)^2 / (1 + 2 w), beta = (1 + w) / (1 + 2 w) (equal steps: 4/3 and 2/3),
//   s^{n+1} = alpha s^n + (1 - alpha) s^{n-1} + beta h s'^{n+1},   s = (x, v),
// is that step over beta h from the state alpha s^n + (1 - alpha) s^{n-1}, whose time is
// (1 - beta) h after s^n (Choi and Ko 2002 take implicit springs in BDF2).
//
// A state that is not the one the last step left, and a vertex that the collider holds, get a
// history of their own, as in Bdf2Stepper: that of a free fall which ends here.
#pragma once

#include "solvers/stepping/stepper.h"

namespace inextensible {

class Bdf2OfEuler final : public Stepper {
 public:
  Bdf2OfEuler(std::shared_ptr<const Problem> problem, std::unique_ptr<Stepper> euler);
  const Positions& filtered_positions() const override { return euler_->filtered_positions(); }
  const char* linear_solver() const override { return euler_->linear_solver(); }
  double reciprocal_condition() const override { return euler_->reciprocal_condition(); }

 private:
  void restart(const State& state, double h);
  StepResult solve(const State& state, double h, Positions& x) override;
  StepResult end_velocities(const State& start, double h, const Positions& filtered,
                            const Positions& x, Positions& v) override;

  std::unique_ptr<Stepper> euler_;
  State ahead_;                    // alpha s^n + (1 - alpha) s^{n-1}, then s^{n+1}
  Positions x_before_, v_before_;  // s^{n-1}
  Positions x_known_, v_known_;    // s^n, as the last step left it
  double h_before_ = 0;            // s; 0: no history
};

}  // namespace inextensible
