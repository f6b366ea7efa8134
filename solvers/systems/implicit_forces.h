// The unconstrained step with forces of its end (Goldenthal et al. 2007, footnote 1), for springs,
// bending and drag too stiff for their forces at the start.
//
// About the free flight y, in which nothing but gravity is missing, backward Euler is
//   (M + h D + h^2 H) (x0 - y) = h^2 (M g - grad V(y)) - h^2 D w,   w the flight's velocity,
// to first order in x0 - y, with V's Hessian H and the drag coefficients D. The constant L >= H
// takes the place of H: of a spring k I between its ends, of bending the Hessian itself. x0 - y is
// O(h^2), so that this costs an error of O(h^4) a step; and the step stays stable at any h, for the
// amplification sqrt(1 / (1 + h^2 L)) of a vibration is below 1 for all H <= L. L is the same for
// all three coordinates: one sparse positive definite n x n matrix, factored once for each h.
//
// Steps short enough for shear at their start take it there, and those short enough for bending
// take both there, which leaves a diagonal matrix of mass and drag. That is more accurate, and
// cheaper: the constraint filter that follows moves the vertices without asking what implicit shear
// would say, an error of first order, which decides into which folds a cloth falls.
//
// Second-order steppers take the forces inside the step, at x_theta = x^n + theta (x0 - x^n):
//   x0 = y + theta h^2 a,   v^{n+1} = v + h a,   M a = -grad V(x_theta) - D v_middle,
// where y and v have gravity already and v_middle = (y - x^n) / h + h a / 2. theta = 1/2 is the
// implicit midpoint rule, which keeps energy (with explicit gravity: Stern and Grinspun 2009); with
// theta = 1 / (1 + rho) the spectral radius at infinite stiffness is rho.
#pragma once

#include <memory>
#include <vector>

#include "solvers/linear/spd_solver.h"
#include "solvers/problem/problem.h"
#include "solvers/problem/work_counters.h"

namespace inextensible {

constexpr const char* singular_forces = "the system of implicit forces is singular";

class ImplicitForces {
 public:
  // The problem must outlive this.
  explicit ImplicitForces(const Problem& problem);

  // Whether a step of h seconds has forces that are not taken at its start.
  bool needed(double h) const { return problem_.has_drag() || h > explicit_step_; }

  // y (3 x n, m) in, x0 out; w: 3 x n, m/s. Pinned vertices of y stay. h: s, of the step from
  // `start`. scale: s, the h of the formula. Shear and bending are taken at x^n + ahead v^n where
  // the step is short enough for that. false: a singular matrix, or a number that is not finite.
  bool advance(const State& start, double h, double scale, double ahead, const Positions& w,
               Positions& y, WorkCounters& work);

  // x0 of the second formula, and its y = x^n + h v + h^2 g / 2 (3 x n, m); theta: 1/2 to 1. In
  // short steps shear and bending are taken at x^n + h v^n / 2. Else as above.
  bool advance_inside(const State& start, double h, double theta, Positions& y, Positions& x0,
                      WorkCounters& work);

 private:
  // What a step of h seconds takes at its end, besides drag.
  enum class Late { nothing, bending, bending_and_shear };
  Late late(double h) const;
  // force_ = M g - grad V - D w, what is late at `end`, the rest at x^n + ahead v^n.
  void find_forces(const State& start, double ahead, Late late, const Positions& end,
                   const Positions& w, WorkCounters& work);
  // The matrix M + drag D + scale^2 L, L of what is late.
  bool factor(double scale, double drag, Late late);
  // y += factor d, with this matrix times d = scale^2 force_.
  bool add_solution(double scale, double drag, Late late, double factor, Positions& y,
                    WorkCounters& work);

  const Problem& problem_;
  std::vector<int> free_vertex_;                        // in elimination order
  struct Entry {                                        // of the matrix
    double shear = 0, bending = 0, drag = 0, mass = 0;  // N/m, N/m, N s/m, kg
  };
  std::vector<Entry> entries_;
  std::unique_ptr<SpdSolver> solver_;
  double explicit_step_ = 0, shear_step_ = 0;  // s
  double factored_ = 0, factored_drag_ = 0;    // s, of the matrix; 0: none yet
  Late factored_late_ = Late::nothing;
  Positions force_;              // N
  Positions inside_, velocity_;  // x_theta and (y - x^n) / h, of advance_inside
  Positions early_;              // x^n + ahead v^n, of short steps
  Eigen::Matrix4Xd motion_;      // m, of the free vertices
};

// Those of a step of h seconds; null: the step takes all forces at its start.
inline ImplicitForces* in_step(const std::unique_ptr<ImplicitForces>& forces, double h) {
  return forces && forces->needed(h) ? forces.get() : nullptr;
}

// x0 of the pipeline of the paper's section 4.4: unconstrained_step, or with `implicit`, if it is
// not null, those forces at the end of the step. false: as ImplicitForces::advance.
bool unconstrained_step(const Problem& problem, ImplicitForces* implicit, const State& state,
                        double h, Positions& x0, WorkCounters& work);

}  // namespace inextensible
