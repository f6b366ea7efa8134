// The variable-step two-step backward differentiation formula BDF2: second order where the one-step
// pipeline is first. With w = h / h_{n-1},
//   alpha = (1 + w)^2 / (1 + 2 w), beta = (1 + w) / (1 + 2 w) (equal steps: 4/3 and 2/3):
//   y^{n+1} = alpha y^n + (1 - alpha) y^{n-1} + beta h y'^{n+1}.
//
// The formula assumes that velocities do not jump. A state that is not the one left by the last
// step gets the history of a free flight that ends here:
//   x^{n-1} = x^n - h v^n + h^2 a / 2,  v^{n-1} = v^n - h a.
// A vertex that the collider holds keeps its history along the surface. Along the normal, and after
// friction has stopped it, it gets the history of a steady motion:
//   x^{n-1} = x^n - h v^n,  v^{n-1} = v^n.
#pragma once

#include "solvers/stepping/velocity_filter.h"

namespace inextensible {

struct Bdf2Coefficients {
  double now, before, beta_h;  // alpha, 1 - alpha, s
};

// What is remembered of the last step.
class Bdf2History {
 public:
  explicit Bdf2History(const Problem& problem);
  // Whether the last step led to `state`, and a step of h seconds may follow it. Pins that follow a
  // body have moved since.
  bool leads_to(const State& state, double h);
  // The flight under `acceleration` (3 x n) that ends in `state`.
  void restart(const State& state, double h, const Positions& acceleration);
  Bdf2Coefficients coefficients(double h) const;
  // The step from `start` led to x with the velocities v by the formula; those of vertices that
  // contacts hold become Contacts::end_velocity, those of pins 0. contacts: null where there is no
  // collider.
  void add_step(const State& start, double h, const Positions& x, const Contacts* contacts,
                Positions& v);

  const Positions& x() const { return x_; }  // x^{n-1}
  const Positions& v() const { return v_; }  // v^{n-1}

 private:
  const Problem& problem_;
  Positions x_, v_;
  Positions x_known_, v_known_;  // x^n and v^n, as the last step left them
  double h_ = 0;                 // s, of the last step; 0: no history
};

// A velocity filter inside BDF2 (constrained dynamics in it: English and Bridson 2008).
//
//   x^{n+1} = alpha x^n + (1 - alpha) x^{n-1} + beta h v^{n+1},
//   v^{n+1} = alpha v^n + (1 - alpha) v^{n-1} + beta h a,
// the filter moves x^{n+1}, and the first line read backwards gives v^{n+1}. Shear and bending are
// taken at x^n + h v^n, which is second order and damps (x extrapolated from x^n and x^{n-1}
// excites), or at x^{n+1}, where the problem asks for it and h is too long (ImplicitForces).
class Bdf2Stepper final : public FilterStepper {
 public:
  Bdf2Stepper(std::shared_ptr<const Problem> problem, std::unique_ptr<VelocityFilter> filter);

 private:
  bool unconstrained(const State& state, double h, Positions& x) override;
  StepResult end_velocities(const State& start, double h, const Positions& x,
                            Positions& v) override;
  // x^{n+1} before the filter, and acceleration_. known: the last step's history goes on.
  void explicit_solve(const State& state, double h, bool known, Positions& x);
  bool implicit_solve(const State& state, double h, bool known, Positions& x);

  Bdf2History history_;
  Positions acceleration_;     // m/s^2, at x_ahead_
  Positions x_ahead_;          // x^n + h v^n, with shear or bending only
  Positions flight_velocity_;  // with implicit forces only
};

}  // namespace inextensible
