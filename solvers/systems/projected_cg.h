// ICD's saddle-point system by projected conjugate gradients (Gould, Hribar and Nocedal 2001).
#pragma once

#include <string_view>
#include <vector>

#include "solvers/linear/spd_solver.h"
#include "solvers/systems/kkt_system.h"
#include "solvers/systems/schur_complement.h"

namespace inextensible {

class ProjectedCg final : public KktSolver {
 public:
  struct Settings {
    double tolerance = 0.1;  // of the step, in the norm of the preconditioner
    int max_iterations = 100;
    std::string_view linear_solver = "multifrontal_mixed";  // for J D^-1 J^T
  };
  // edges: best in elimination_order.
  ProjectedCg(const Problem& problem, const EdgeConstraints& edges, const Settings& settings);

  bool factor(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& mu, const Contacts* contacts,
              bool convex, WorkCounters& work) override;
  bool solve(const Positions& r, const Eigen::VectorXd& c, Positions& p, Eigen::VectorXd& q,
             WorkCounters& work) override;
  bool takes_contacts() const override { return true; }
  double reciprocal_condition() const override {
    return direct_in_use_ ? direct_->reciprocal_condition() : solver_->reciprocal_condition();
  }

 private:
  enum class Outcome { converged, negative_curvature, failed };

  bool factor_directly(WorkCounters& work);
  bool touches() const { return contacts_ && contacts_->count() > 0; }
  void set_curvature(bool convex);
  Outcome iterate(const Positions& r, const Eigen::VectorXd& c, Positions& p, Eigen::VectorXd& q,
                  WorkCounters& work);
  Outcome finish(Positions& p) const;
  bool precondition(Positions& r, const Eigen::VectorXd* c, Positions& p, Eigen::VectorXd& q,
                    WorkCounters& work);
  void apply_hessian(const Positions& p, Positions& y) const;
  void subtract_gradients(const Eigen::VectorXd& q, Positions& r) const;

  const Problem& problem_;
  const EdgeConstraints& edges_;
  Settings settings_;
  SchurComplement schur_;  // J D^-1 J^T
  std::unique_ptr<SpdSolver> solver_;
  const Contacts* contacts_ = nullptr;
  std::unique_ptr<KktSystem> direct_;  // made when first needed
  bool direct_in_use_ = false;

  const Eigen::Matrix3Xd* u_ = nullptr;
  const Eigen::VectorXd* mu_ = nullptr;
  bool convex_ = false;
  Eigen::VectorXd mass_;            // scaled by the mean mass
  Eigen::VectorXd curvature_;       // of H, an edge each
  Eigen::VectorXd inverse_metric_;  // D^-1, a vertex each
  Positions residual_, direction_, image_, correction_;
  Eigen::VectorXd dq_;
};

}  // namespace inextensible
