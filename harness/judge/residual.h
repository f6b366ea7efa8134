// The residual of fast projection (Goldenthal et al. 2007, section 4.2 and Figure 3), off the
// clock: after iteration j, F_j = (x_j - x_0) + h^2 W J(x_j)^T lambda_j with lambda_j the sum of
// the dlambda so far, says how far the iterate is from the solution of implicit constraint
// directions.
#pragma once

#include <optional>

#include "inextensible/systems/constraint_system.h"

namespace harness {

class ResidualProbe {
 public:
  ResidualProbe(std::shared_ptr<const inextensible::Problem> problem, double strain_limit);

  struct Residuals {
    double first = 0, last = 0;  // mean of |F| over vertices after the first, the last iteration, m
    int iterations = 0;
  };
  // Repeats the projection that a step from `start` does. Nothing if it needs no iteration or
  // fails.
  std::optional<Residuals> of_step(const inextensible::State& start, double h);

 private:
  double mean_residual(const inextensible::Positions& x);

  std::shared_ptr<const inextensible::Problem> problem_;
  inextensible::ConstraintSystem system_;
  inextensible::WorkCounters work_;  // nobody's
  inextensible::Positions x0_, x_, f_;
  Eigen::Matrix3Xd u_;
  Eigen::VectorXd mu_, sum_;
};

}  // namespace harness
