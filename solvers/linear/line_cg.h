// Conjugate gradients for J W J^T at sizes where factors grow too large, preconditioned by its
// lines: the yarns of the cloth.
#pragma once

#include <cstdint>

#include "solvers/linear/spd_solver.h"

namespace inextensible {

class LineCgSolver final : public SpdSolver {
 public:
  // Any order of rows, best one in which neighbours are near each other. Throws
  // std::invalid_argument for a lower triangle.
  explicit LineCgSolver(SymmetricPattern pattern);

  double* values() override { return values_.data(); }
  // Factors the lines; false: one of them is not positive definite, so neither is the matrix. The
  // first call finds the lines: strong couplings there and then.
  bool factor() override;
  void solve(double* rhs) override { solve_within(tightest, rhs); }
  // false: not positive definite (a direction of negative curvature), not finite, or not reached
  // after the largest number of iterations.
  bool solve_within(double tolerance, double* rhs) override;
  std::int64_t iterations() const override { return iterations_; }
  double reciprocal_condition() const override;  // of the lines' pivots
  double factor_nonzeros() const override { return 2.0 * pattern_.n - lines_; }
  double factor_flops() const override { return 3.0 * pattern_.n; }

  void set_most_iterations(int limit) { most_iterations_ = limit; }

  int lines() const { return lines_; }
  // x = diag(T_A, T_B)^-1 x, rows as in the matrix: every line's own system.
  void solve_lines(double* x);
  // Whether the row's line is coupled with no other line of its kind.
  bool eliminated(int row) const { return family_of_[row] == 0; }

 private:
  // Rows of lines, each after its predecessor on the line, otherwise in the order given.
  struct Family {
    std::vector<int> row;          // of the matrix
    std::vector<int> previous;     // place of the predecessor; a first one's is its own
    std::vector<int> diagonal_at;  // in values_
    std::vector<int> link_at;      // of the entry that couples it with its predecessor, -1: none
    // T = (D + E) D^-1 (D + E)^T: diagonal of D^-1, and E, whose rows have one entry
    std::vector<double> inverse_pivot, link;

    int size() const { return static_cast<int>(row.size()); }
    bool factor(const double* values, double least_pivot);
    // x = T^-1 b, returns b . x; b may be x, the number then means nothing.
    double solve(const double* b, double* x) const;
  };
  struct Graph;  // of the matrix, while lines are sought

  void find_lines();
  void join_strongest(Graph& graph) const;
  void cut_chords(Graph& graph) const;
  void choose_families(const Graph& graph);
  void place_rows(const Graph& graph);
  void place_couplings(const Graph& graph);
  double multiply(const double* p, double* q);

  SymmetricPattern pattern_;
  std::vector<double> values_;
  int lines_ = 0;
  std::vector<int> family_of_, place_;  // of each row
  Family eliminated_, kept_;
  // C: a row for each kept one, a column for each eliminated one; R: what couples kept rows of
  // different lines, row by row its entries left of the diagonal.
  struct Couplings {
    std::vector<int> start, column, at;  // at: in values_
    std::vector<double> value;
    void gather(const double* values);
  } across_, among_;
  // Vectors of CG on kept rows; the last on eliminated ones.
  std::vector<double> solution_, residual_, direction_, line_direction_, product_, beyond_;
  std::int64_t iterations_ = 0;
  int most_iterations_ = 1000;
};

}  // namespace inextensible
