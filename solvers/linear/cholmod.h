// CHOLMOD's simplicial and supernodal Cholesky (Chen, Davis, Hager and Rajamanickam 2008) on a
// matrix in elimination order.
#pragma once

#include <memory>

#include "solvers/linear/spd_solver.h"

namespace inextensible {

class CholmodSolver final : public SpdSolver {
 public:
  CholmodSolver(SymmetricPattern pattern, bool supernodal);
  ~CholmodSolver() override;
  double* values() override { return values_.data(); }
  bool factor() override;
  void solve(double* rhs) override;
  double reciprocal_condition() const override;
  double factor_nonzeros() const override;
  double factor_flops() const override;

 private:
  struct Library;  // CHOLMOD's objects, kept out of this header
  SymmetricPattern pattern_;
  std::vector<double> values_;
  std::unique_ptr<Library> library_;
};

}  // namespace inextensible
