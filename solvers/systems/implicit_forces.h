// The unconstrained step with forces of its end (Goldenthal et al. 2007, footnote 1), for springs,
// bending and drag too stiff for their forces at the start.
//
// About the free flight y, in which nothing but gravity is missing, backward Euler is
//   (M + h D + h^2 H) (x0 - y) = h^2 (M g - grad V(y)) - h^2 D w,   w the flight's velocity,
// to first order in x0 - y, with V's Hessian H and the drag coefficients D. The constant L >= H
// takes the place of H: of a spring k I between its ends, of bending the Hessian itself. x0 - y is
// O(h^2), so that this costs an error of O(h^4) a step; and the step stays stable at any h, for the
// amplification sqrt(1 / (1 + h^2 L)) of a vibration is below 1 for all H <= L. L is the same for
// all three coordinates: one sparse symmetric positive definite n x n matrix, factored once for
// each h.
#pragma once

#include <memory>
#include <vector>

#include "solvers/linear/spd_solver.h"
#include "solvers/problem/problem.h"
#include "solvers/problem/work_counters.h"

namespace inextensible {

class ImplicitForces {
 public:
  // The problem must outlive this.
  explicit ImplicitForces(const Problem& problem);

  // y (3 x n, m) in, x0 out; w: 3 x n, m/s. Pinned vertices of y stay. scale: s, the h of the
  // formula. false: the matrix is singular to working precision, or a number is not finite.
  bool advance(double scale, const Positions& w, Positions& y, WorkCounters& work);

 private:
  bool factor(double scale);

  const Problem& problem_;
  std::vector<int> free_vertex_;               // in elimination order
  struct Entry {                               // of the matrix
    double stiffness = 0, drag = 0, mass = 0;  // N/m, N s/m, kg
  };
  std::vector<Entry> entries_;
  std::unique_ptr<SpdSolver> solver_;
  double factored_ = 0;  // s, the scale; 0: none yet
  Positions force_;      // N
  Eigen::VectorXd row_;  // one coordinate of all free vertices
};

}  // namespace inextensible
