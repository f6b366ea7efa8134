// L D L^T of symmetric block tridiagonal matrices of 3 x 3 blocks (the springs of a chain, a rope,
// a hair), from both ends at once: O(n), no pivoting, no indices.
#pragma once

#include "solvers/linear/spd_solver.h"

namespace inextensible {

class BlockTridiagonalSolver final : public SpdSolver {
 public:
  // The pattern: an upper triangle that holds every entry of the 3 x 3 blocks on the diagonal and
  // beside it (zeros are stored).
  explicit BlockTridiagonalSolver(const SymmetricPattern& pattern);
  ~BlockTridiagonalSolver() override;

  double* values() override { return values_.data(); }
  bool factor() override;
  void solve(double* rhs) override;
  double reciprocal_condition() const override;
  double factor_nonzeros() const override { return static_cast<double>(values_.size()); }
  double factor_flops() const override;

 private:
  struct Row;  // of blocks

  std::vector<double> values_;
  std::vector<Row> rows_;
};

}  // namespace inextensible
