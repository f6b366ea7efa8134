#include "solvers/linear/spd_solver.h"

#include <stdexcept>
#include <string>

namespace inextensible {
namespace {

// For a problem without constraints or free vertices: not all libraries accept empty matrices.
struct NoEquations : SpdSolver {
  bool factor() override { return true; }
  void solve(double* /*rhs*/) override {}
  double factor_nonzeros() const override { return 0; }
  double factor_flops() const override { return 0; }
};

}  // namespace

void SpdSolver::solve_coordinates(Eigen::Matrix4Xd& rhs) {
  for (int axis = 0; axis < 3; ++axis) {
    one_ = rhs.row(axis);
    solve(one_.data());
    rhs.row(axis) = one_;
  }
}

const SpdSolverRow& spd_solver(std::string_view name) {
  for (const SpdSolverRow& row : spd_solvers())
    if (row.name == name) return row;
  throw std::invalid_argument("no linear solver '" + std::string(name) + "' in this library");
}

std::unique_ptr<SpdSolver> make_spd_solver(std::string_view name, SymmetricPattern pattern) {
  const SpdSolverRow& row = spd_solver(name);
  if (pattern.n == 0) return std::make_unique<NoEquations>();
  return row.make(std::move(pattern));
}

}  // namespace inextensible
