#include <stdexcept>
#include <string>

#include "solvers/linear/multifrontal_cholesky.h"
#include "solvers/linear/spd_solver.h"

namespace inextensible {

// Solvers whose classes are private to their files.
std::unique_ptr<SpdSolver> make_tridiagonal(SymmetricPattern pattern);
std::unique_ptr<SpdSolver> make_block_tridiagonal(SymmetricPattern pattern);
std::unique_ptr<SpdSolver> make_cholmod_supernodal(SymmetricPattern pattern);

namespace {

template <class Solver>
std::unique_ptr<SpdSolver> make(SymmetricPattern pattern) {
  return std::make_unique<Solver>(std::move(pattern));
}

constexpr auto lower = SymmetricPattern::Triangle::lower;
constexpr auto upper = SymmetricPattern::Triangle::upper;

// For a problem without constraints or free vertices: not all libraries accept empty matrices.
class NoEquations : public SpdSolver {
 public:
  bool factor() override { return true; }
  void solve(double* /*rhs*/) override {}
  double factor_nonzeros() const override { return 0; }
  double factor_flops() const override { return 0; }
};

// CHOLMOD's supernodal code transposes an upper triangle at every factorization; the up-looking
// codes a lower one.
constexpr SpdSolverRow table[] = {
    {"tridiagonal", "L D L^T from both ends", upper, Takes::tridiagonal, make_tridiagonal},
    {"block_tridiagonal", "the same of 3 x 3 blocks", upper, Takes::block_tridiagonal,
     make_block_tridiagonal},
    {"multifrontal", "multifrontal Cholesky, laid out once", lower, Takes::any,
     make<MultifrontalCholesky<double>>},
    {"multifrontal_mixed", "the same in single precision where that is enough", lower, Takes::any,
     make<MixedCholesky>, Precision::mixed},
    {"cholmod_supernodal", "CHOLMOD's supernodal Cholesky", lower, Takes::any,
     make_cholmod_supernodal},
};

}  // namespace

void SpdSolver::solve_coordinates(Eigen::Matrix4Xd& rhs) {
  for (int axis = 0; axis < 3; ++axis) {
    one_ = rhs.row(axis);
    solve(one_.data());
    rhs.row(axis) = one_;
  }
}

std::span<const SpdSolverRow> spd_solvers() { return table; }

const SpdSolverRow& spd_solver(std::string_view name) {
  for (const SpdSolverRow& row : table) {
    if (row.name == name) return row;
  }
  throw std::invalid_argument("no linear solver '" + std::string(name) + "'");
}

std::unique_ptr<SpdSolver> make_spd_solver(std::string_view name, SymmetricPattern pattern) {
  const SpdSolverRow& row = spd_solver(name);
  if (pattern.n == 0) return std::make_unique<NoEquations>();
  return row.make(std::move(pattern));
}

}  // namespace inextensible
