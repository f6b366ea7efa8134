// The variable-step formula BDF2 and the step that it remembers. With w = h / h_{n-1},
//   alpha = (1 + w)^2 / (1 + 2 w), beta = (1 + w) / (1 + 2 w) (equal steps: 4/3 and 2/3):
//   y^{n+1} = alpha y^n + (1 - alpha) y^{n-1} + beta h y'^{n+1}.
//
// The formula assumes that velocities do not jump. A state that is not the one left by the last
// step, and a vertex that the collider holds, get the history of a free flight that ends here:
//   x^{n-1} = x^n - h v^n + h^2 a / 2,  v^{n-1} = v^n - h a.
#pragma once

#include "solvers/problem/contacts.h"

namespace inextensible {

struct Bdf2Coefficients {
  double now, before, beta_h;  // alpha, 1 - alpha, s
};

class Bdf2History {
 public:
  explicit Bdf2History(const Problem& problem);
  // Whether the last step led to `state`, and a step of h seconds may follow it. Pins that follow a
  // body have moved since.
  bool leads_to(const State& state, double h);
  // The flight under `acceleration` (3 x n) that ends in `state`.
  void restart(const State& state, double h, const Positions& acceleration);
  Bdf2Coefficients coefficients(double h) const;
  // The step from `start` led to x with the velocities v; those of vertices that contacts hold
  // become (x - x^n) / h, those of pins 0. contacts: null where there is no collider.
  void add_step(const State& start, double h, const Positions& x, const Positions& acceleration,
                const Contacts* contacts, Positions& v);

  const Positions& x() const { return x_; }  // x^{n-1}
  const Positions& v() const { return v_; }  // v^{n-1}
  std::int64_t restarts() const { return restarts_; }

 private:
  const Problem& problem_;
  Positions x_, v_;
  Positions x_known_, v_known_;  // x^n and v^n, as the last step left them
  double h_ = 0;                 // s, of the last step; 0: no history
  std::int64_t restarts_ = 0;
};

}  // namespace inextensible
