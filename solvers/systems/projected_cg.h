// ICD's saddle-point system by projected conjugate gradients (Gould, Hribar and Nocedal 2001).
#pragma once

#include <string_view>
#include <vector>

#include "solvers/systems/contact_terms.h"
#include "solvers/systems/kkt_solver.h"
#include "solvers/systems/kkt_system.h"
#include "solvers/systems/schur_complement.h"

namespace inextensible {

// The order of a problem's edges in which J W J^T factors with little fill.
std::vector<int> elimination_order(const Problem& problem);

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
  // Where two edges meet, with the sign of the product of their gradients' ends; the vertex after
  // the last, of weight 0, where they do not.
  struct Meeting {
    int vertex;
    double sign;
  };
  enum class Outcome { converged, negative_curvature, failed };

  void find_meetings();
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
  SymmetricPattern pattern_;
  std::vector<Meeting> first_, second_;  // an entry of pattern_ each
  std::unique_ptr<SpdSolver> solver_;
  const Contacts* contacts_ = nullptr;
  std::unique_ptr<ContactTerms> contact_terms_;  // where the problem has contact inside
  std::unique_ptr<KktSystem> direct_;            // made when first needed
  bool direct_in_use_ = false;

  const Eigen::Matrix3Xd* u_ = nullptr;
  const Eigen::VectorXd* mu_ = nullptr;
  bool convex_ = false;
  Eigen::VectorXd mass_;            // scaled by the mean mass
  Eigen::VectorXd curvature_;       // of H, an edge each
  Eigen::VectorXd inverse_metric_;  // D^-1, a vertex each and one 0
  Positions residual_, direction_, image_, correction_;
  Eigen::VectorXd dq_;
};

}  // namespace inextensible
