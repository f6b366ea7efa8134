// SHAKE (Ryckaert, Ciccotti and Berendsen 1977) as a global Newton method: constraint forces act
// along the gradient at the start of the step, the matrix is built once a step and again only if
// convergence fails (Barth et al. 1994).
#pragma once

#include "constraint_system.h"
#include "unsymmetric_solver.h"

namespace inextensible {

class Shake final : public VelocityFilter {
 public:
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 50;
    std::string_view linear_solver = "auto";
  };
  Shake(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Positions& x, WorkCounters& work) override;
  const char* linear_solver() const override { return system_.solver_name().c_str(); }

 private:
  bool rebuild(WorkCounters& work);

  ConstraintSystem system_;
  int vertices_;
  int max_iterations_;
  Eigen::Matrix3Xd u_start_, u_;
  Eigen::VectorXd c_, mu_;  // C(x_j), and the step's h^2 dlambda
  Positions best_;          // iterate of least |C|
  double full_step_ = 0;    // |mu_| before halving
  // J(x_j) W J(x^n)^T, made at the first failure to converge: most runs never need it.
  std::unique_ptr<UnsymmetricSchurComplement> current_;
  std::unique_ptr<UnsymmetricSolver> current_solver_;
};

}  // namespace inextensible
