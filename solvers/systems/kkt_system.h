// Linear solvers for ICD's Newton step, the saddle-point (KKT) system
//   [ M + H(mu)  J^T ] [ p ]   [ r ]      H(mu) = sum_k mu_k grad^2 C_k: a weighted graph Laplacian
//   [ J           0  ] [ q ] = [ c ]      times the 3 x 3 identity, 2 mu_k / l_k an edge.
// Pinned vertices have no unknowns. Masses and mu are scaled by the mean mass, so that both blocks
// are of order one.
#pragma once

#include <string_view>

#include "solvers/problem/contacts.h"
#include "solvers/problem/edge_constraints.h"

namespace inextensible {

// A solver, and another one that takes over where it fails, if it has one.
class KktSolver {
 public:
  KktSolver(const Problem& problem, const EdgeConstraints& edges);
  virtual ~KktSolver() = default;
  KktSolver(const KktSolver&) = delete;
  KktSolver& operator=(const KktSolver&) = delete;

  // Takes gradients u (3 x m) and scaled multipliers mu / mean_mass (m), both of which must stay as
  // they are until the last solve; false: singular. convex: negative multipliers (compressed edges)
  // are left out of H, so that M + H is positive definite. A solver that finds M + H indefinite on
  // the null space of J does so by itself. contacts: their vertices move within their planes only;
  // null or empty: none, as must be where the solver does not take them.
  bool factor(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& mu, const Contacts* contacts,
              bool convex, WorkCounters& work);
  virtual bool takes_contacts() const { return false; }

  // Whether they were left out, of the last solve.
  bool convexified() const { return convexified_; }

  // [p; q] = K^-1 [r; c]; r and p are 3 x n (pinned columns: ignored, zero), c and q have m
  // entries; false: too inaccurate.
  bool solve(const Positions& r, const Eigen::VectorXd& c, Positions& p, Eigen::VectorXd& q,
             WorkCounters& work);

 protected:
  // Where iterative refinement of a solve ends, and what is good enough if that is not reached:
  // residuals relative to the right-hand side. Newton converges as well with the latter.
  static constexpr double refinement_goal = 1e-10, acceptable_residual = 1e-6;

  double curvature(Eigen::Index k) const {  // of edge k in H
    const double mu = (*mu_)[k];
    return convexified_ && mu < 0 ? 0 : 2 * mu * edges_.inverse_rest_length[k];
  }

  const Problem& problem_;
  const EdgeConstraints& edges_;
  double mean_mass_;
  // From the last factor(); convex_ is what the other solver is asked for.
  const Eigen::Matrix3Xd* u_ = nullptr;
  const Eigen::VectorXd* mu_ = nullptr;
  const Contacts* contacts_ = nullptr;
  bool convex_ = false, convexified_ = false;

 private:
  virtual bool factor_itself(WorkCounters& work) = 0;
  virtual bool solve_itself(const Positions& r, const Eigen::VectorXd& c, Positions& p,
                            Eigen::VectorXd& q, WorkCounters& work) = 0;
  virtual std::unique_ptr<KktSolver> make_other() const { return nullptr; }
  bool leave_to_other(WorkCounters& work);

  std::unique_ptr<KktSolver> other_;  // made when first needed; knows no contacts
  bool left_to_other_ = false;
};

// The matrix in fixed pattern, factored: L D L^T without pivoting in a fill-reducing order, of K
// with a tiny negative diagonal in the lower block, corrected by iterative refinement on K itself.
// Where refinement does not reach its goal (H indefinite enough to ruin the pivots, or masses too
// unequal) UMFPACK takes over for that matrix.
enum class FactoredBy { ldlt_first, umfpack };
std::unique_ptr<KktSolver> make_kkt_system(const Problem& problem, const EdgeConstraints& edges,
                                           FactoredBy by = FactoredBy::ldlt_first);

// Projected conjugate gradients (Gould, Hribar, Nocedal 2001). edges: best in elimination_order.
struct ProjectedCgSettings {
  double tolerance = 0.1;  // of the step, in the norm of the preconditioner
  int max_iterations = 100;
  std::string_view linear_solver = "multifrontal_mixed";  // for J D^-1 J^T
};
std::unique_ptr<KktSolver> make_projected_cg(const Problem& problem, const EdgeConstraints& edges,
                                             const ProjectedCgSettings& settings);

// Whether each edge joins a vertex to the next one, none twice, and no pins hold vertices between
// them: their chain would have a multiplier more than vertices.
bool forms_chains(const Problem& problem);
// Block elimination along such chains; a matrix that it cannot take is left to UMFPACK. Throws
// std::invalid_argument for other problems.
std::unique_ptr<KktSolver> make_chain_kkt(const Problem& problem, const EdgeConstraints& edges);

}  // namespace inextensible
