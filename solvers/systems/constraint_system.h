// A problem's edges in elimination order and the solver for their J W J^T: what projections share.
#pragma once

#include <string>

#include "solvers/linear/spd_solver.h"
#include "solvers/problem/step_result.h"
#include "solvers/systems/schur_complement.h"

namespace inextensible {

class ConstraintSystem {
 public:
  // linear_solver: a name of make_spd_solver, or "auto": tridiagonal for a chain, else
  // multifrontal, or multifrontal_mixed where solves will ask for few digits. Edges are renumbered
  // once, so that no factorization has to permute.
  enum class Digits { all, few };
  ConstraintSystem(const Problem& problem, double strain_limit, std::string_view linear_solver,
                   Digits digits = Digits::all);

  const EdgeConstraints& edges() const { return *edges_; }
  const SchurComplement& schur() const { return *schur_; }
  // J W J^T counts as singular where a pivot keeps less than this of its diagonal entry:
  // multipliers would outgrow the corrections that they make, and cancel.
  static constexpr double least_pivot = 1e-10;
  // Solvers without pivots show it by multipliers this many times the largest right-hand side over
  // the diagonal. A chain's may grow with its length squared.
  static constexpr double largest_growth = 1e8;

  const std::string& solver_name() const { return solver_name_; }
  // Whether J W J^T is tridiagonal: a projection costs no more than some passes over edges.
  bool chain() const { return chain_; }

  // Assembles J W J^T at gradients u, its diagonal times 1 + damping, and factors it; false: not
  // positive definite. contacts: their vertices move within their planes only, so that W (I - n
  // n^T) takes the place of W; null: none.
  bool factor(const Eigen::Matrix3Xd& u, const Contacts* contacts, WorkCounters& work,
              double damping = 0);
  // mu = (J W J^T)^-1 mu, to a residual of `tolerance` times the right-hand side. false: the
  // residual stayed above it, or the multipliers grew too large; mu is unspecified.
  bool solve(Eigen::VectorXd& mu, WorkCounters& work, double tolerance = SpdSolver::tightest);

 private:
  std::string solver_name_;
  bool chain_ = false;
  std::unique_ptr<EdgeConstraints> edges_;
  std::unique_ptr<SchurComplement> schur_;
  std::unique_ptr<SpdSolver> solver_;
};

// A refusal that names the worst edge at x; its status is not_finite if that edge's length is not.
StepResult refuse(Status status, int iterations, const EdgeConstraints& edges, const Positions& x,
                  const char* detail);

}  // namespace inextensible
