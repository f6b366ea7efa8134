// Linear solvers for ICD's Newton step, the saddle-point (KKT) system
//   [ M + H(mu)  J^T ] [ p ]   [ r ]      H(mu) = sum_k mu_k grad^2 C_k: a weighted graph Laplacian
//   [ J           0  ] [ q ] = [ c ]      times the 3 x 3 identity, 2 mu_k / l_k an edge.
// Pinned vertices have no unknowns. Masses and mu are scaled by the mean mass, so that both blocks
// are of order one.
#pragma once

#include <memory>

#include "solvers/linear/lu.h"
#include "solvers/linear/quasi_definite.h"
#include "solvers/problem/contacts.h"
#include "solvers/problem/edge_constraints.h"

namespace inextensible {

// Where iterative refinement of a solve ends, and what is good enough if that is not reached:
// residuals relative to the right-hand side. Newton converges as well with the latter.
inline constexpr double refinement_goal = 1e-10, acceptable_residual = 1e-6;

class KktSolver {
 public:
  explicit KktSolver(const Problem& problem);
  virtual ~KktSolver() = default;
  KktSolver(const KktSolver&) = delete;
  KktSolver& operator=(const KktSolver&) = delete;

  // Takes gradients u (3 x m) and scaled multipliers mu / mean_mass (m), both of which must stay as
  // they are until the last solve; false: singular. convex: negative multipliers (compressed edges)
  // are left out of H, so that M + H is positive definite. A solver that finds M + H indefinite on
  // the null space of J does so by itself. contacts: their vertices move within their planes only;
  // null or empty: none, as must be where the solver does not take them.
  virtual bool factor(const Eigen::Matrix3Xd& u, const Eigen::VectorXd& mu,
                      const Contacts* contacts, bool convex, WorkCounters& work) = 0;
  virtual bool takes_contacts() const { return false; }

  // Whether they were left out, of the last solve.
  bool convexified() const { return convexified_; }

  // [p; q] = K^-1 [r; c]; r and p are 3 x n (pinned columns: ignored, zero), c and q have m
  // entries; false: too inaccurate.
  virtual bool solve(const Positions& r, const Eigen::VectorXd& c, Positions& p, Eigen::VectorXd& q,
                     WorkCounters& work) = 0;

  // Estimate for the last factorization, from its pivots.
  virtual double reciprocal_condition() const = 0;

  double mean_mass() const { return mean_mass_; }

 protected:
  double mean_mass_;
  bool convexified_ = false;
};

// The matrix in fixed pattern, factored:
// L D L^T without pivoting in a fill-reducing order, of K with a tiny negative diagonal in the
// lower block, corrected by iterative refinement on K itself. Where refinement does not reach its
// goal (H indefinite enough to ruin the pivots, or masses that are too unequal) UMFPACK takes over
// for that matrix.
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
  struct EdgePlaces {  // of entries, by axis
    int coupling[3], at_a[3], at_b[3];
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
  std::vector<int> diagonal_;   // the place of each unknown's diagonal entry
  std::vector<EdgePlaces> edge_places_;
  std::unique_ptr<QuasiDefiniteSolver> ldlt_;
  std::unique_ptr<UnsymmetricSolver> lu_;
  std::vector<int> full_from_upper_;
  Eigen::VectorXd rhs_, solution_, residual_;
};

// Whether each edge joins a vertex to the next one, none twice, and no pins hold vertices between
// them: their chain would have a multiplier more than vertices.
bool forms_chains(const Problem& problem);
// Block elimination along such chains; a matrix that it cannot take is left to UMFPACK. Throws
// std::invalid_argument for other problems.
std::unique_ptr<KktSolver> make_chain_kkt(const Problem& problem, const EdgeConstraints& edges);

}  // namespace inextensible
