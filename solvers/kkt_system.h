// The saddle-point (KKT) matrix of ICD's Newton step in fixed pattern:
//   K = [ M + H(mu)  J^T ]     H(mu) = sum_k mu_k grad^2 C_k, a weighted graph Laplacian times the
//   3 x 3 identity:
//       [ J           0  ]     edge (a, b) adds +2 mu_k / l_k at (a, a), (b, b) and its negative at
//       (a, b), (b, a).
// Pinned vertices have no unknowns. Masses are scaled by their mean, so that both blocks are of
// order one.
//
// Two factorizations: `quasi_definite` is L D L^T without pivoting in a fill-reducing order, of K
// with a tiny negative diagonal in the lower block (Vanderbei 1995), corrected by iterative
// refinement on K itself; where refinement does not reach its goal (H indefinite enough to spoil
// the pivots) UMFPACK takes over for that matrix. `umfpack` always uses it.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "edge_constraints.h"
#include "eigen_ldlt_solver.h"
#include "unsymmetric_solver.h"

namespace inextensible {

class KktSystem {
 public:
  // linear_solver: "quasi_definite" or "umfpack".
  KktSystem(const Problem& problem, const EdgeConstraints& edges, std::string_view linear_solver);

  // Sets and factors K for gradients u (3 x m) and scaled multipliers mu / mean_mass (m); false:
  // singular. convex: negative multipliers (compressed edges) are left out of H, so that M + H is
  // positive definite. The quasi-definite factorization does that by itself when its pivots show
  // the wrong inertia (as interior-point methods do: Waechter and Biegler 2006, section 3.1).
  bool factor(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& mu, bool convex,
              WorkCounters& work);
  bool convexified() const { return convexified_; }

  // [p; q] = K^-1 [r; c]; r and p are 3 x n (pinned columns: ignored, zero), c and q have m
  // entries; false: too inaccurate.
  bool solve(const Positions& r, const Eigen::VectorXd& c, Positions& p, Eigen::VectorXd& q,
             WorkCounters& work);

  // Of the last factorization, from its pivots.
  double reciprocal_condition() const {
    return using_umfpack_ ? lu_->reciprocal_condition() : ldlt_->reciprocal_condition();
  }

  double mean_mass() const { return mean_mass_; }

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
  bool convexified_ = false;
  double mean_mass_;
  std::vector<int> vertex_unknown_;  // first of a vertex's three unknowns, -1 if pinned
  std::vector<double> scaled_mass_;  // per free vertex place, m / mean_mass
  int size_ = 0, multiplier_offset_ = 0;
  std::vector<int> place_;  // unknown -> row in elimination order
  SymmetricPattern pattern_;
  std::vector<double> matrix_;  // upper triangle of K, without the regularization
  std::vector<VertexPlaces> vertex_places_;
  std::vector<EdgePlaces> edge_places_;
  std::unique_ptr<EigenLdltSolver> ldlt_;
  std::unique_ptr<UnsymmetricSolver> lu_;
  std::vector<int> full_from_upper_;
  Eigen::VectorXd rhs_, solution_, residual_;
};

}  // namespace inextensible
