// Strips while they converge quickly, fast projection's step for the whole cloth where they do not:
// a yarn carries corrections along itself at once, but across yarns they travel by passes.
#pragma once

#include <memory>

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/methods/yarn_pass.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class FastProjectionAdaptive final : public VelocityFilter {
 public:
  // What each is for stands in fields().
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 5000;
    int sweeps = 20;
    double relaxation = 1.8;
    double target = 0.8;
    double sweep_target = 0.8;
    double forcing = 1e-2;
    std::string_view linear_solver = "auto";
  };
  static SettingFields<Settings> fields();
  FastProjectionAdaptive(const Problem& problem, const Settings& settings,
                         Along along = Along::edges);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;
  const char* linear_solver() const override { return system_.solver_name().c_str(); }
  double reciprocal_condition() const override { return system_.reciprocal_condition(); }

 private:
  enum Way { rounds_alone, with_the_whole };  // how a step is done
  Way choose();
  bool too_expensive(int rounds, double cost) const;
  void learn(Way way, double cost);
  double linearize();
  bool project_the_whole(Contacts* contacts, WorkCounters& work);

  ConstraintSystem system_;
  Settings settings_;
  Along along_;
  StrainPasses passes_;
  YarnPass yarns_;
  Positions x_;
  Eigen::Matrix3Xd u_;        // gradient of C
  Eigen::Matrix3Xd u_start_;  // at x^n, for the middle of the step only
  Eigen::VectorXd mu_;        // C~, then h^2 dlambda
  Iterate::Record before_;    // a projection of the whole
  // What steps have cost each way, in visits of an edge; 0: not tried yet.
  struct Seen {
    double mean[2] = {};
    Way cheaper = rounds_alone;
    int retry_interval = 0, until_retry = 0;  // steps until the more expensive way is tried again
  } seen_;
};

Backend fast_projection_adaptive_row();

}  // namespace inextensible
