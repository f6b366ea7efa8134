// Implicit constraint direction (Goldenthal et al. 2007, section 4.1): constraint forces act along
// J at the end of the step.
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/systems/active_contacts.h"
#include "solvers/systems/constraint_system.h"
#include "solvers/systems/kkt_solver.h"

namespace inextensible {

class Icd final : public VelocityFilter {
 public:
  // What each is for stands in fields().
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 200;
    int min_iterations = 0;
    double target = 0;
    double direction_tolerance = 0.1;
    std::string_view linear_solver = "auto";
    double cg_tolerance = 0.03;
  };
  static SettingFields<Settings> fields();
  Icd(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;
  const char* linear_solver() const override { return linear_solver_.c_str(); }
  double reciprocal_condition() const override { return kkt_->reciprocal_condition(); }

 private:
  void evaluate(const Positions& dx);
  StepResult closest(double h, Iterate x, WorkCounters& work);
  bool direction(const Contacts* contacts, bool convex, WorkCounters& work);
  bool line_search(WorkCounters& work);
  StepResult newton(double h, Iterate x, WorkCounters& work);

  const Problem& problem_;
  std::string linear_solver_;
  EdgeConstraints edges_;
  std::unique_ptr<KktSolver> kkt_;
  int max_iterations_, min_iterations_;
  double target_;
  double direction_tolerance_;  // m
  Eigen::VectorXd mass_;        // scaled by the mean mass, as mu is
  ActiveContacts active_;

  Positions x0_, trial_, dx_, trial_dx_, f_, dp_;  // f_ = M F = M dx + J^T mu
  Eigen::Matrix3Xd u_;
  Eigen::VectorXd c_, mu_, trial_mu_, dq_;  // c_: what of C lies beyond the target
  bool permissible_ = false;
  double largest_f_ = 0;             // m, over vertices
  double merit_ = 0;                 // sum of |F|^2 and C^2, m^2
  Eigen::VectorXd previous_lambda_;  // mu / h^2 of the last solve that converged
};

}  // namespace inextensible
