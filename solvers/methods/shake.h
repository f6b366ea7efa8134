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
  // What each is for stands in fields().
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 50;
    int min_iterations = 0;
    double target = 0;
    double forcing = 1e-2;
    std::string_view linear_solver = "auto";
  };
  static SettingFields<Settings> fields();
  Shake(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;

  // RATTLE's velocity stage (Andersen 1983): v -= W J^T nu with J = J(x), so that J v = 0, and
  // nothing moves through a plane that holds it. Without contacts the factor is kept: a step that
  // starts at this x does not build it again. contacts: null, or those of this step.
  StepResult project_velocity(const Positions& x, const Contacts* contacts, Positions& v,
                              WorkCounters& work);

  const char* linear_solver() const override { return system_.solver_name().c_str(); }
  double reciprocal_condition() const override { return system_.reciprocal_condition(); }

 private:
  // Which matrix stands in (7): that of the start of the step; the true one, J(x_j) W J(x^n)^T, of
  // this iterate or of an earlier one.
  enum class Matrix { start, here, kept };
  // J(x_start) W J(x_start)^T, unless it is there already. False if it is not positive definite.
  bool factor_start(const Positions& x_start, const Contacts* contacts, WorkCounters& work);
  bool factor_here(const Contacts* contacts, WorkCounters& work);
  bool solve(Matrix matrix, WorkCounters& work);
  bool linearize(const Positions& x);
  void correct(Iterate x);
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
  Iterate::Record best_;    // of least |C|
  // J(x_j) W J(x^n)^T, made at the first failure to converge: most runs never need it.
  std::unique_ptr<UnsymmetricSchurComplement> current_;
  std::unique_ptr<UnsymmetricSolver> current_solver_;
  std::unique_ptr<ContactTerms> current_contact_terms_;  // with contacts only
};

}  // namespace inextensible
