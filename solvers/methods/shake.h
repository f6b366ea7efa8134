// SHAKE (Ryckaert, Ciccotti and Berendsen 1977) as a global Newton method: constraint forces act
// along the gradient at the start of the step, the matrix is built once a step and again only if
// convergence fails (Barth et al. 1994).
#pragma once

#include "solvers/linear/lu.h"
#include "solvers/methods/setting_fields.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class Shake final : public VelocityFilter {
 public:
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 50;
    int min_iterations = 0;  // even where the candidate is permissible already
    double target = 0;       // of the strain limit; as FastProjection's
    // Of linear solvers that iterate; a frozen matrix converges linearly anyway.
    double forcing = 1e-2;
    std::string_view linear_solver = "auto";
  };
  static SettingFields<Settings> fields();
  Shake(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Positions& x, WorkCounters& work) override;

  void heed(Contacts* contacts) override;

  // RATTLE's velocity stage (Andersen 1983): v -= W J^T nu with J = J(x), so that J v = 0, and
  // nothing moves through a plane that holds it. Without contacts the factor is kept: a step that
  // starts at this x does not build it again.
  StepResult project_velocity(const Positions& x, Positions& v, WorkCounters& work);

  const char* linear_solver() const override { return system_.solver_name().c_str(); }
  double reciprocal_condition() const override { return system_.reciprocal_condition(); }

 private:
  // J(x_start) W J(x_start)^T, unless it is there already. False if it is not positive definite.
  bool factor_start(const Positions& x_start, WorkCounters& work);
  bool linearize(const Positions& x);
  bool rebuild(WorkCounters& work);
  void correct(Positions& x);
  void take_back(Positions& x);
  // |x - x_start| in the norm of M.
  double distance(const Positions& x_start, const Positions& x) const;

  ConstraintSystem system_;
  const Problem& problem_;
  double slack_;  // M-norm of what the strain limit lets vertices drift
  int max_iterations_, min_iterations_;
  double target_, forcing_;
  Eigen::Matrix3Xd u_start_, u_;
  Positions x_factored_;  // where the factor in system_ was built; used by RATTLE only
  bool factored_ = false;
  Eigen::VectorXd c_, mu_;  // C~(x_j), and the step's h^2 dlambda
  Positions best_;          // iterate of least |C|
  double full_step_ = 0;    // |mu_| before halving
  // J(x_j) W J(x^n)^T, made at the first failure to converge: most runs never need it.
  std::unique_ptr<UnsymmetricSchurComplement> current_;
  std::unique_ptr<UnsymmetricSolver> current_solver_;
  // With contacts only.
  Contacts::Record best_contacts_;
  std::unique_ptr<ContactTerms> current_contact_terms_;
};

Backend shake_row();

}  // namespace inextensible
