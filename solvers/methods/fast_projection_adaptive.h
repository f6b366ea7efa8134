// Strips while they converge quickly, fast projection's step for the whole cloth where they do not:
// a yarn carries corrections along itself at once, but across yarns they travel by sweeps.
#pragma once

#include <memory>

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/methods/yarn_pass.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class FastProjectionAdaptive final : public VelocityFilter {
 public:
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 5000;  // rounds a step: a pass over all yarns, then sweeps
    int sweeps = 20;            // of a round, at most; none where yarns share no vertex
    double relaxation = 1.8;    // of a sweep's correction
    double target = 0.8;        // of the strain limit: what yarns and the whole are projected to
    double sweep_target = 0.8;  // and what a sweep brings an edge to
    double forcing = 1e-2;      // residual of a linear solve, of its right-hand side
    std::string_view linear_solver = "auto";
  };
  static SettingFields<Settings> fields();
  FastProjectionAdaptive(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Positions& x, WorkCounters& work) override;
  void heed(Contacts* contacts) override {
    VelocityFilter::heed(contacts);
    sweep_.heed(contacts);
    yarns_.heed(contacts);
    system_.heed(contacts);
  }
  const char* linear_solver() const override { return system_.solver_name().c_str(); }
  double reciprocal_condition() const override { return system_.reciprocal_condition(); }

 private:
  enum Way { rounds_alone, with_the_whole };  // how a step is done
  Way choose();
  bool too_dear(int rounds, double price) const;
  void learn(Way way, double price);
  bool project_the_whole(WorkCounters& work);

  ConstraintSystem system_;
  Settings settings_;
  StrainPasses sweep_;
  YarnPass yarns_;
  Positions x_;
  Eigen::Matrix3Xd u_;                      // gradient of C
  Eigen::VectorXd mu_;                      // C~, then h^2 dlambda
  Contacts::Record start_record_, record_;  // with contacts only
  // What steps have cost each way, in visits of an edge; 0: not tried yet.
  struct Seen {
    double mean[2] = {};
    Way cheaper = rounds_alone;
    int holiday = 0, until_trial = 0;  // steps until the dearer way is tried again
  } seen_;
};

Backend fast_projection_adaptive_row();
// The same inside BDF2 (bdf2_stepper.h).
Backend fast_projection_adaptive_bdf2_row();

}  // namespace inextensible
