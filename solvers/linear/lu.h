// LU of general sparse matrices with one pattern: UMFPACK (Davis 2004), or LAPACK's tridiagonal LU
// where that fits.
#pragma once

#include <memory>

#include "solvers/linear/symmetric_pattern.h"

namespace inextensible {

class UnsymmetricSolver {
 public:
  explicit UnsymmetricSolver(int entries) : values_(entries) {}
  virtual ~UnsymmetricSolver() = default;
  UnsymmetricSolver(const UnsymmetricSolver&) = delete;
  UnsymmetricSolver& operator=(const UnsymmetricSolver&) = delete;

  double* values() { return values_.data(); }  // in the pattern's order
  virtual bool factor() = 0;            // false: singular to working precision, or not finite
  virtual void solve(double* rhs) = 0;  // overwritten by the solution; after a successful factor()
  virtual double reciprocal_condition() const = 0;  // an estimate from the pivots
  virtual double factor_nonzeros() const = 0;       // of L + U
  virtual double factor_flops() const = 0;

 protected:
  std::vector<double> values_;
};

// The pattern has both triangles. Tridiagonal ones get the tridiagonal solver.
std::unique_ptr<UnsymmetricSolver> make_unsymmetric_solver(SymmetricPattern pattern);

}  // namespace inextensible
