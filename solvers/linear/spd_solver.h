// Linear solvers for symmetric positive definite systems that are factored many times with one
// pattern.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string_view>

#include "solvers/linear/symmetric_pattern.h"

namespace inextensible {

// Use: write the matrix to values() in the pattern's order, factor(), solve() any number of times.
// The matrix is factored in its own order; permute it first (fill_reducing_order).
class SpdSolver {
 public:
  explicit SpdSolver(int entries = 0) : values_(entries) {}
  virtual ~SpdSolver() = default;
  SpdSolver(const SpdSolver&) = delete;
  SpdSolver& operator=(const SpdSolver&) = delete;

  virtual double* values() { return values_.data(); }  // in the pattern's order
  // false: not finite, or a pivot of L D L^T is not above least_pivot times the diagonal entry that
  // it came from. (The supernodal code takes any positive pivot.)
  virtual bool factor() = 0;
  // 0 (the default) takes every positive pivot; 1e-10 refuses matrices in which ten digits are
  // lost.
  void set_least_pivot(double relative) { least_pivot_ = relative; }
  virtual void solve(
      double* rhs) = 0;  // n numbers, overwritten by the solution; after a successful factor()
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
  // An estimate, of the last successful factorization: smallest over largest pivot of L D L^T.
  virtual double reciprocal_condition() const = 0;
  virtual double factor_nonzeros() const = 0;
  virtual double factor_flops() const = 0;  // of one factorization

 protected:
  std::vector<double> values_;
  double least_pivot_ = 0;

 private:
  Eigen::VectorXd one_;  // right-hand side of several
};

// ---- The list of them: a new one is its file and one row in spd_solvers.cpp ----

enum class Takes { any, tridiagonal, block_tridiagonal };  // patterns; blocks are 3 x 3
enum class Precision { full, mixed };                      // of the factors

struct SpdSolverRow {
  const char* name;
  const char* summary;
  SymmetricPattern::Triangle triangle;  // that it reads
  Takes takes;
  bool fills;  // wants rows in an order of little fill; others do without or find their own
  Precision precision;
  std::unique_ptr<SpdSolver> (*make)(SymmetricPattern);
};

std::span<const SpdSolverRow> spd_solvers();
// Throws std::invalid_argument, naming it, if there is none.
const SpdSolverRow& spd_solver(std::string_view name);

// Throws std::invalid_argument for a name not in the list or a pattern that the solver cannot take.
std::unique_ptr<SpdSolver> make_spd_solver(std::string_view name, SymmetricPattern pattern);

}  // namespace inextensible
