// The residual of a projection method (Goldenthal et al. 2007, section 4.2 and Figure 3), off the
// clock: after iteration j, F_j = (x_j - x_0) + h^2 W J(x_j)^T lambda_j with lambda_j the sum of
// the dlambda so far, says how far the iterate is from the solution of implicit constraint
// directions. Iterates and multipliers are those of the solver that runs.
#pragma once

#include <optional>

#include "solvers/problem/edge_constraints.h"
#include "solvers/stepping/stepper.h"

namespace harness {

class ResidualProbe final : public inextensible::IterateObserver {
 public:
  struct Residuals {
    double first = 0, last = 0;  // mean of |F| over vertices after the first, the last iteration, m
    int iterations = 0;
  };
  // Looks at the next step, until it is asked for its residuals; else iterates pass unseen.
  void watch();
  // Residual of the step since watch(), once accepted. Nothing if it needed no iteration.
  std::optional<Residuals> residuals();

  void iterate(const inextensible::EdgeConstraints& edges, int j, const inextensible::Positions& x,
               const Eigen::VectorXd& multipliers) override;

 private:
  struct Iterate {
    inextensible::Positions x;
    Eigen::VectorXd multipliers;
  };
  double mean_residual(const Iterate& at) const;

  bool watching_ = false;
  const inextensible::EdgeConstraints* edges_ = nullptr;  // the solver's
  int iterations_ = 0;
  inextensible::Positions x0_;
  Iterate first_, last_;
};

}  // namespace harness
