// Direct solvers for linear systems that are factored many times with one pattern.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string_view>

#include "solvers/linear/symmetric_pattern.h"

namespace inextensible {

// Use: write the matrix to values() in the pattern's order, factor(), solve() any number of times.
class DirectSolver {
 public:
  explicit DirectSolver(int entries) : values_(entries) {}
  virtual ~DirectSolver() = default;
  DirectSolver(const DirectSolver&) = delete;
  DirectSolver& operator=(const DirectSolver&) = delete;

  virtual double* values() { return values_.data(); }  // in the pattern's order
  virtual bool factor() = 0;            // false: singular to working precision, or not finite
  virtual void solve(double* rhs) = 0;  // overwritten by the solution; after a successful factor()
  virtual double factor_nonzeros() const = 0;  // of all factors
  virtual double factor_flops() const = 0;     // of one factorization

 protected:
  std::vector<double> values_;
};

// For symmetric positive definite matrices. Factored in their own order: permute them first
// (fill_reducing_order). factor() is false for a pivot of L D L^T that is not above least_pivot
// times the diagonal entry that it came from. (The supernodal code takes any positive pivot.)
class SpdSolver : public DirectSolver {
 public:
  explicit SpdSolver(int entries = 0) : DirectSolver(entries) {}
  // 0, the default, takes all positive pivots; 1e-10 refuses matrices in which ten digits are lost.
  void set_least_pivot(double relative) { least_pivot_ = relative; }
  // Three right-hand sides at once, the coordinates of a vertex in each column; its fourth number
  // means nothing.
  virtual void solve_coordinates(Eigen::Matrix4Xd& rhs);
  // A solver of mixed precision stops once |b - A x| <= tolerance |b|. false: not reached; rhs is
  // then unspecified.
  virtual bool solve_within(double /*tolerance*/, double* rhs) {
    solve(rhs);
    return true;
  }
  static constexpr double tightest = 1e-12;  // tolerance that is sure to be reached

 protected:
  double least_pivot_ = 0;

 private:
  Eigen::VectorXd one_;  // right-hand side of several
};

// LU of general sparse matrices: UMFPACK (Davis 2004), or LAPACK's tridiagonal LU where that fits.
// The pattern has both triangles.
std::unique_ptr<DirectSolver> make_lu_solver(SymmetricPattern pattern);

// ---- The list of SPD solvers: a new one is its file and one row in spd_solvers.cpp ----

enum class Takes { any, tridiagonal, block_tridiagonal };  // patterns; blocks are 3 x 3
enum class Precision { full, mixed };                      // of the factors

struct SpdSolverRow {
  const char* name;
  SymmetricPattern::Triangle triangle;  // that it reads
  Takes takes;                          // those of any pattern want rows in an order of little fill
  std::unique_ptr<SpdSolver> (*make)(SymmetricPattern);
  Precision precision = Precision::full;
};

std::span<const SpdSolverRow> spd_solvers();
// Throws std::invalid_argument, naming it, if there is none.
const SpdSolverRow& spd_solver(std::string_view name);

// Throws std::invalid_argument for a name not in the list or a pattern that the solver cannot take.
std::unique_ptr<SpdSolver> make_spd_solver(std::string_view name, SymmetricPattern pattern);

}  // namespace inextensible
