// Linear solvers for ICD's Newton step, the saddle-point (KKT) system
//   [ M + H(mu)  J^T ] [ p ]   [ r ]      H(mu) = sum_k mu_k grad^2 C_k: a weighted graph Laplacian
//   [ J           0  ] [ q ] = [ c ]      times the 3 x 3 identity, 2 mu_k / l_k an edge.
// Pinned vertices have no unknowns. Masses and mu are scaled by the mean mass, so that both blocks
// are of order one.
#pragma once

#include <memory>
#include <string_view>

#include "solvers/problem/contacts.h"
#include "solvers/problem/edge_constraints.h"
#include "solvers/problem/work_counters.h"

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

}  // namespace inextensible
