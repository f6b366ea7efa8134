// A velocity filter inside the two-step backward differentiation formula BDF2: second order where
// the one-step pipeline is first (English and Bridson 2008 take constrained dynamics there this
// way).
//
// With w = h / h_{n-1}, alpha = (1 + w)^2 / (1 + 2 w) and beta = (1 + w) / (1 + 2 w) (equal steps:
// 4/3 and 2/3):
//   x^{n+1} = alpha x^n + (1 - alpha) x^{n-1} + beta h v^{n+1},
//   v^{n+1} = alpha v^n + (1 - alpha) v^{n-1} + beta h a,
// the filter moves x^{n+1}, and the first line read backwards gives v^{n+1}. Shear and bending are
// taken at x^n + h v^n, which is second order and damps (x extrapolated from x^n and x^{n-1}
// excites), or at x^{n+1}, where the problem asks for it (ImplicitForces).
//
// The formula assumes that velocities do not jump. A vertex that the collider moved, or a state
// that is not the one left by the last step, gets a history of its own: that of a vertex which came
// here under its present acceleration a, x^{n-1} = x^n - h v^n + h^2 a / 2 and v^{n-1} = v^n - h a.
#pragma once

#include "solvers/stepping/velocity_filter.h"

namespace inextensible {

// Variable-step BDF2 is stable for steps that grow by less than 1 + sqrt 2.
constexpr double largest_bdf2_growth = 2;

class Bdf2Stepper final : public Stepper {
 public:
  Bdf2Stepper(std::shared_ptr<const Problem> problem, std::unique_ptr<VelocityFilter> filter);
  const char* linear_solver() const override { return filter_->linear_solver(); }
  double reciprocal_condition() const override { return filter_->reciprocal_condition(); }
  void observe(IterateObserver* observer) override { filter_->observe(observer); }

  // How often the whole history was made anew: first step, foreign state, step grown more than
  // twofold.
  std::int64_t restarts() const { return restarts_; }

 private:
  struct Coefficients {
    double now, before, beta_h;
  };
  Coefficients coefficients(double h) const;
  StepResult solve(const State& state, double h, Positions& x) override;
  StepResult end_velocities(const State& start, double h, const Positions& filtered,
                            const Positions& x, Positions& v) override;
  void restart(const State& state, double h);
  // x^{n+1} before the filter, and acceleration_. known: the last step's history goes on.
  void explicit_solve(const State& state, double h, bool known, Positions& x);
  bool implicit_solve(const State& state, double h, bool known, Positions& x);

  std::unique_ptr<VelocityFilter> filter_;
  Positions x_before_, v_before_;             // x^{n-1}, v^{n-1}
  Positions x_known_, v_known_;               // x^n and v^n as the last step left them
  double h_before_ = 0;                       // s; 0: no history
  Positions acceleration_;                    // m/s^2, at x_ahead_
  Positions x_ahead_;                         // x^n + h v^n, with shear or bending only
  std::unique_ptr<ImplicitForces> implicit_;  // null: forces at x_ahead_
  Positions flight_velocity_;                 // with implicit forces only
  std::int64_t restarts_ = 0;
};

}  // namespace inextensible
