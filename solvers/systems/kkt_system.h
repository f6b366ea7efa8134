// The saddle-point matrix of ICD's Newton step in fixed pattern, factored.
//
// L D L^T without pivoting in a fill-reducing order, of K with a tiny negative diagonal in the
// lower block, corrected by iterative refinement on K itself. Where refinement does not reach its
// goal (H indefinite enough to ruin the pivots, or masses that are too unequal) UMFPACK takes over
// for that matrix.
#pragma once

#include <memory>

#include "solvers/linear/lu.h"
#include "solvers/linear/quasi_definite.h"
#include "solvers/systems/kkt_solver.h"

namespace inextensible {

class KktSystem final : public KktSolver {
 public:
  enum class By { ldlt_first, umfpack };
  KktSystem(const Problem& problem, const EdgeConstraints& edges, By by = By::ldlt_first);

  bool factor(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& mu, const Contacts* contacts,
              bool convex, WorkCounters& work) override;
  bool solve(const Positions& r, const Eigen::VectorXd& c, Positions& p, Eigen::VectorXd& q,
             WorkCounters& work) override;
  double reciprocal_condition() const override {
    return using_umfpack_ ? lu_->reciprocal_condition() : ldlt_->reciprocal_condition();
  }

 private:
  struct VertexPlaces {
    int diagonal[3];
  };
  struct EdgePlaces {
    int coupling[3], at_a[3], at_b[3], lower;
  };

  void build_pattern(const std::vector<Edge>& unknown_ends);
  void assemble(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& mu, bool convex);
  void residual();  // residual_ = rhs_ - K solution_
  bool factor_umfpack(WorkCounters& work);

  const EdgeConstraints& edges_;
  bool umfpack_only_;
  bool using_umfpack_ = false;
  std::vector<int> vertex_unknown_;  // first of a vertex's three unknowns, -1 if pinned
  std::vector<double> scaled_mass_;  // per free vertex place, m / mean_mass
  int size_ = 0, multiplier_offset_ = 0;
  std::vector<int> place_;  // unknown -> row in elimination order
  SymmetricPattern pattern_;
  std::vector<double> matrix_;  // upper triangle of K, without the regularization
  std::vector<VertexPlaces> vertex_places_;
  std::vector<EdgePlaces> edge_places_;
  std::unique_ptr<QuasiDefiniteSolver> ldlt_;
  std::unique_ptr<UnsymmetricSolver> lu_;
  std::vector<int> full_from_upper_;
  Eigen::VectorXd rhs_, solution_, residual_;
};

}  // namespace inextensible
