// A velocity filter inside the two-step backward differentiation formula BDF2: second order where
// the one-step pipeline is first (English and Bridson 2008 take constrained dynamics there this
// way).
//
//   x^{n+1} = alpha x^n + (1 - alpha) x^{n-1} + beta h v^{n+1},
//   v^{n+1} = alpha v^n + (1 - alpha) v^{n-1} + beta h a,
// the filter moves x^{n+1}, and the first line read backwards gives v^{n+1}. Shear and bending are
// taken at x^n + h v^n, which is second order and damps (x extrapolated from x^n and x^{n-1}
// excites), or at x^{n+1}, where the problem asks for it (ImplicitForces).
#pragma once

#include "solvers/stepping/bdf2_history.h"
#include "solvers/stepping/velocity_filter.h"

namespace inextensible {

class Bdf2Stepper final : public Stepper {
 public:
  Bdf2Stepper(std::shared_ptr<const Problem> problem, std::unique_ptr<VelocityFilter> filter);
  const char* linear_solver() const override { return filter_->linear_solver(); }
  double reciprocal_condition() const override { return filter_->reciprocal_condition(); }
  void observe(IterateObserver* observer) override { filter_->observe(observer); }

  // How often the whole history was restarted: first step, foreign state, step grown more than
  // twofold.
  std::int64_t restarts() const { return history_.restarts(); }

 private:
  StepResult solve(const State& state, double h, Positions& x) override;
  StepResult end_velocities(const State& start, double h, const Positions& filtered,
                            const Positions& x, Positions& v) override;
  // x^{n+1} before the filter, and acceleration_. known: the last step's history goes on.
  void explicit_solve(const State& state, double h, bool known, Positions& x);
  bool implicit_solve(const State& state, double h, bool known, Positions& x);

  std::unique_ptr<VelocityFilter> filter_;
  Bdf2History history_;
  Positions acceleration_;                    // m/s^2, at x_ahead_
  Positions x_ahead_;                         // x^n + h v^n, with shear or bending only
  std::unique_ptr<ImplicitForces> implicit_;  // null: forces at x_ahead_
  Positions flight_velocity_;                 // with implicit forces only
};

}  // namespace inextensible
