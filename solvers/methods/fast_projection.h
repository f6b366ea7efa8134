// Fast projection (Goldenthal et al. 2007, Algorithm 1): steps of least M-norm towards the
// constraint manifold.
#pragma once

#include <memory>

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class FastProjection final : public VelocityFilter {
 public:
  // What each is for stands in fields().
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 200;
    int min_iterations = 0;
    int smoothing_sweeps = 0;
    double smoothing_target = 0.5;
    double smoothing_relaxation = 1.4;
    int sweeps_before = 0;
    double target = 0;
    double inner_band = 0.6;
    double first_forcing = 1e-2;
    std::string_view linear_solver = "auto";
  };
  static SettingFields<Settings> fields();
  FastProjection(const Problem& problem, const Settings& settings, Along along = Along::edges);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;
  const char* linear_solver() const override { return system_.solver_name().c_str(); }
  double reciprocal_condition() const override { return system_.reciprocal_condition(); }

 private:
  bool linearize(double target, const Positions& x);
  void correct(Iterate x);
  void keep_best(Iterate x);
  void restore_best(Iterate x);
  void pass(int most, Iterate x, WorkCounters& work);
  void show(int j, const Positions& x);
  StepResult damped(int j, Iterate x, WorkCounters& work);
  double damped_prediction(double damping) const;

  ConstraintSystem system_;
  Settings settings_;
  Along along_;
  std::unique_ptr<StrainPasses> passes_;  // where some are asked for
  Iterate::Record best_;                  // x_j of least constraint error
  Eigen::Matrix3Xd u_;                    // gradient of C at x_j, or in the middle of the step
  Eigen::Matrix3Xd u_start_;              // at x^n, for the middle of the step only
  Eigen::VectorXd mu_;                    // C~(x_j), then h^2 dlambda
  Eigen::VectorXd excess_;                // C~ of a damped iteration
  // With an observer only: h^2 lambda at x_j and at best_.
  Eigen::VectorXd multipliers_, best_multipliers_;
};

}  // namespace inextensible
