// Registered as `oracle`, no contestant: the M-closest point of {C = 0} (ICD = SAP, Goldenthal
// et al. 2007, Theorem 1) to 1e-12, by dense Newton with full pivoting. Slow and obvious:
// what tests compare with, for small n.
#pragma once

#include <Eigen/Dense>

#include "solvers/methods/backend.h"
#include "solvers/stepping/velocity_filter.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class DenseOracle final : public VelocityFilter {
 public:
  static constexpr int largest_problem = 600;  // vertices
  // Throws std::invalid_argument for more vertices than largest_problem.
  explicit DenseOracle(const Problem& problem);
  StepResult apply(const Positions& x_start, double h, Iterate iterate,
                   WorkCounters& work) override;
  // Multipliers h^2 lambda of the last accepted step, one an edge, kg m.
  const Eigen::VectorXd& multipliers() const { return mu_; }

 private:
  const Problem& problem_;
  EdgeConstraints edges_;
  Eigen::VectorXd mu_;
};

Backend oracle_row();

}  // namespace inextensible
