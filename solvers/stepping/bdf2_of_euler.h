// BDF2 around a method that is a backward Euler step of its own (Choi and Ko 2002 take implicit
// springs in BDF2). With s = (x, v), the formula (bdf2_history.h) is that step over beta h from the
// state alpha s^n + (1 - alpha) s^{n-1}, whose time is (1 - beta) h after s^n.
#pragma once

#include "solvers/stepping/bdf2_history.h"
#include "solvers/stepping/stepper.h"

namespace inextensible {

class Bdf2OfEuler final : public Stepper {
 public:
  Bdf2OfEuler(std::shared_ptr<const Problem> problem, std::unique_ptr<Stepper> euler);
  const Positions& filtered_positions() const override { return euler_->filtered_positions(); }
  const char* linear_solver() const override { return euler_->linear_solver(); }
  double reciprocal_condition() const override { return euler_->reciprocal_condition(); }

 private:
  StepResult solve(const State& state, double h, Positions& x) override;
  StepResult end_velocities(const State& start, double h, const Positions& filtered,
                            const Positions& x, Positions& v) override;

  std::unique_ptr<Stepper> euler_;
  Bdf2History history_;
  Positions gravity_;  // of every vertex
  State ahead_;        // alpha s^n + (1 - alpha) s^{n-1}, then s^{n+1}
};

}  // namespace inextensible
