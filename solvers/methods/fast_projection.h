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
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 200;
    // Iterations even where the candidate is permissible already: one keeps slack within the limit
    // from building up over steps, at the price of a solve in steps that would need none.
    int min_iterations = 0;
    // Colored Gauss-Seidel sweeps after each projection, at most. A projection sees the whole
    // cloth, but only to first order; most of what it leaves is local, and cheaper to mend by
    // sweeps. Not on chains, where a projection costs no more than some sweeps.
    int smoothing_sweeps = 0;
    double smoothing_target = 0.5;      // of the strain limit
    double smoothing_relaxation = 1.4;  // of a correction
    // The same sweeps before the first projection, at most: what they mend is nothing to project.
    int sweeps_before = 0;
    // A projection takes back all of an edge's strain at 0, which gives energy to edges that have
    // drifted within the limit for some steps; else what lies beyond this fraction of the limit.
    double target = 0;
    // The same where J W J^T is singular: a straight row at full length has no neighbour with C =
    // 0, but many permissible ones.
    double inner_band = 0.6;
    double first_forcing = 1e-2;
    std::string_view linear_solver = "auto";
  };
  // searched_sweeps: `bench tune` looks for their number and target, too. Algorithm 1 has none.
  static SettingFields<Settings> fields(bool searched_sweeps = false);
  FastProjection(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Positions& x, WorkCounters& work) override;
  void heed(Contacts* contacts) override;
  const char* linear_solver() const override { return system_.solver_name().c_str(); }
  double reciprocal_condition() const override { return system_.reciprocal_condition(); }

 private:
  bool linearize(double target, const Positions& x);
  void correct(Positions& x);
  void keep_best(const Positions& x);
  void smooth(Positions& x, WorkCounters& work);
  void sweep(int sweeps, Positions& x, WorkCounters& work);
  void show(int j, const Positions& x);
  StepResult damped(int j, Positions& x, WorkCounters& work);
  double damped_prediction(double damping) const;

  ConstraintSystem system_;
  Settings settings_;
  std::unique_ptr<StrainPasses> sweep_;  // with sweeps only
  Positions best_;                       // x_j of least constraint error
  Eigen::Matrix3Xd u_;                   // gradient of C at x_j
  Eigen::VectorXd mu_;                   // C~(x_j), then h^2 dlambda
  Eigen::VectorXd excess_;               // C~ of a damped iteration
  // With an observer only: h^2 lambda at x_j and at best_.
  Eigen::VectorXd multipliers_, best_multipliers_;
  Contacts::Record best_contacts_;  // at best_; with contacts only
};

Backend fast_projection_row();
// Inside BDF2 (each projection followed by some colored Gauss-Seidel sweeps), and BDF2 blended with
// BDF3 (bdf2_stepper.h).
Backend fast_projection_bdf2_row();
Backend fast_projection_bdf2opt_row();

}  // namespace inextensible
