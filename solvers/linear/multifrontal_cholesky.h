// L D L^T of positive definite matrices that share one pattern, for thousands of factorizations:
// the multifrontal method (Duff and Reid 1983; Liu 1992), with everything that depends on the
// pattern alone done once.
//
// Columns of L with (nearly) the same rows below form a supernode. Its front is a dense lower
// trapezoid over those rows: the entries of A in its columns, plus what its children in the
// elimination tree leave over. The columns are eliminated by dense steps; what that subtracts from
// the rows below, with what the children leave there, is its update matrix, for the parent.
//
// The constructor lays out supernodes and their rows (CHOLMOD's analysis), and the place of every
// entry of A and every row of an update matrix in its front. Update matrices lie on two stacks, for
// even and odd depths of the tree: a front's is made on one while its children's, the last ones on
// the other, are read and dropped.
//
// The dense steps take panels of up to eight columns, whose number is a template argument: eight
// columns of the panel against four of the target in one loop over rows, four doubles (eight
// floats) at once, by the compiler's vector types. Panels lie one after the other, each without the
// rows above it, and have room for whole groups of rows: most fronts are so small that a loop's
// remainder would cost more than the loop.
#pragma once

#include "solvers/linear/spd_solver.h"

namespace inextensible {

// Real: double, or float where seven digits do: half the memory, twice the numbers an instruction.
template <class Real>
class MultifrontalCholesky final : public SpdSolver {
 public:
  // Reads the lower triangle, in elimination order, postordered (fill_reducing_order). Throws
  // std::invalid_argument for the upper one, std::bad_alloc if CHOLMOD runs out of memory.
  explicit MultifrontalCholesky(SymmetricPattern pattern);

  bool factor() override;
  void solve(double* rhs) override;
  void solve_coordinates(Eigen::Matrix4Xd& rhs) override;
  // Those of L itself; a third more is stored, for whole groups of rows and merged supernodes.
  double factor_nonzeros() const override { return nonzeros_; }
  double factor_flops() const override { return flops_; }
  // From the last successful factorization: the smallest pivot over its diagonal entry. How rows
  // are scaled does not show in it, nor in the solve's accuracy.
  double least_relative_pivot() const;

 private:
  struct Front {
    int first_column, columns, rows;   // rows: the own columns' and those below
    int entries_begin, entries_end;    // of A, in the pattern's order
    int children_begin, children_end;  // in children_
    int own_of_parent;                 // of its rows below, how many are own columns of the parent
    int stack;                         // 0 or 1, the depth's parity: where the update matrix is
    std::size_t rows_at, factor_at, update_at;
    int below() const { return rows - columns; }
  };

  void find_fronts();
  void place_entries();
  void link_fronts();
  void place_updates();
  int place_in(const Front& front, int row) const;
  template <class Into>
  void add_update(const Front& child, int begin, int end, Into into) const;
  bool eliminate_columns(const Front& front, Real* columns, Real* update);
  // width: numbers of right-hand sides in a row, 1 or 4.
  template <int width>
  void substitute(Real* rhs);

  SymmetricPattern pattern_;
  std::vector<Front> fronts_;     // in elimination order
  std::vector<int> rows_;         // of the matrix, below each front's own columns, ascending
  std::vector<int> entry_place_;  // of A's entries in their front's columns
  std::vector<int> children_;
  std::vector<int> parent_place_;  // of each of rows_ in the parent's front
  std::vector<Real> factor_;       // the fronts' panels
  std::vector<Real> updates_[2];   // the stacks
  std::vector<Real> pivots_;       // of L D L^T
  std::vector<Real> front_rows_;   // solve(): one number a row of a front, or four
  std::vector<Real> rounded_;      // in single precision: the right-hand side, or four
  double nonzeros_ = 0, flops_ = 0;
};

// A factorization in single precision where that is enough, in double precision where it is not:
// for solves that are asked for few digits (SpdSolver::solve_within). Right-hand sides and
// solutions are in double precision; more digits than the factorization has come by iterative
// refinement (Wilkinson 1963), whose residuals are computed in double precision.
class MixedCholesky final : public SpdSolver {
 public:
  explicit MixedCholesky(SymmetricPattern pattern);  // as MultifrontalCholesky's

  double* values() override { return single_.values(); }
  // In double precision if a pivot has too few digits in single precision.
  bool factor() override;
  void solve(double* rhs) override { solve_within(tightest, rhs); }
  // Without refinement: in single precision where the pivots promise five digits.
  void solve_coordinates(Eigen::Matrix4Xd& rhs) override;
  // Without a look at the residual where the pivots promise more than `tolerance`. In double
  // precision if refinement does not get there; false if the matrix is not positive definite then.
  bool solve_within(double tolerance, double* rhs) override;
  double factor_nonzeros() const override { return single_.factor_nonzeros(); }
  double factor_flops() const override { return single_.factor_flops(); }

  bool in_double_precision() const { return in_double_; }  // the last factor() or solve

 private:
  bool factor_in_double();
  bool refine(double tolerance, double* x);
  void subtract_product(const double* x);

  SymmetricPattern pattern_;
  MultifrontalCholesky<float> single_;
  MultifrontalCholesky<double> double_;
  std::vector<double> rhs_, residual_;
  bool in_double_ = false;
  double accuracy_ = 0;  // of a solve in single precision, as the pivots promise it
};

}  // namespace inextensible
