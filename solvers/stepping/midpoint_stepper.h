// A velocity filter inside the midpoint rule, for filters whose constraint forces act along the
// edges as they are in the middle of the step (Along::middle). With x0 = x^n + h v^n + h^2/2 W f,
//   x^{n+1} = x0 + h^2 / (1 + rho) W J(m)^T lambda,  m = (x^n + x^{n+1}) / 2,
//   v^{n+1} = v^n + h W f + h W J(m)^T lambda = v^n + h W f + (1 + rho) (x^{n+1} - x0) / h.
//
// C is quadratic, so J(m) (x^{n+1} - x^n) = C(x^{n+1}) - C(x^n) exactly: where lengths stay what
// they are, constraint forces do no work, and with rho = 1 energy and momentum are kept at any step
// (Simo and Tarnow 1992; Gonzalez 1999). With directions of the end of a step instead, as in
// Algorithm 1 of Goldenthal et al. 2007, they brake.
//
// rho, 0 to 1, is the spectral radius at infinite stiffness (Chung and Hulbert 1993): of a rate
// that constraints stop, -rho times as much is left after the step. So an edge that comes to its
// limit bounces there unless rho is less than 1. With 1 the rule is of second order; what is
// smaller acts on constraint forces alone. Vertices that an obstacle holds do not bounce
// (Contacts::end_velocity). f has shear and bending at x^n + h v^n / 2, drag at v^n;
// implicit forces join the constraint forces, with the same rho (ImplicitForces).
#pragma once

#include "solvers/stepping/velocity_filter.h"

namespace inextensible {

class MidpointStepper final : public FilterStepper {
 public:
  // spectral_radius: rho, 0 to 1.
  MidpointStepper(std::shared_ptr<const Problem> problem, std::unique_ptr<VelocityFilter> filter,
                  double spectral_radius);

 private:
  bool unconstrained(const State& state, double h, Positions& x0) override;
  StepResult end_velocities(const State& start, double h, const Positions& x,
                            Positions& v) override;

  double rho_;
  Positions middle_;     // x^n + h v^n / 2
  Positions candidate_;  // x0 before implicit forces
};

}  // namespace inextensible
