#include "spd_solver.h"

#include <stdexcept>
#include <string>

#include "block_tridiagonal_solver.h"
#include "cholmod_solver.h"
#include "eigen_ldlt_solver.h"
#include "fixed_pattern_cholesky.h"
#include "hybrid_spd_solver.h"
#include "line_cg_solver.h"
#include "mixed_cholesky.h"
#include "tridiagonal_solver.h"

namespace inextensible {

namespace {

// Whether every entry lies in a block of `size` rows and columns that is on the diagonal or beside
// it.
bool near_diagonal(const SymmetricPattern& pattern, int size) {
  for (int column = 0; column < pattern.n; ++column) {
    const auto c = static_cast<std::size_t>(column);
    for (int i = pattern.column_start[c]; i < pattern.column_start[c + 1]; ++i) {
      const int distance = pattern.row_index[static_cast<std::size_t>(i)] / size - column / size;
      if (distance < -1 || distance > 1) return false;
    }
  }
  return true;
}

}  // namespace

bool SymmetricPattern::tridiagonal() const { return near_diagonal(*this, 1); }

bool SymmetricPattern::block_tridiagonal() const { return n % 3 == 0 && near_diagonal(*this, 3); }

SymmetricPattern::Triangle triangle_of(std::string_view solver) {
  // CHOLMOD's supernodal code transposes an upper triangle at every factorization; the up-looking
  // codes a lower one.
  return solver == "cholmod_supernodal" || solver.starts_with("fixed_pattern")
             ? SymmetricPattern::Triangle::lower
             : SymmetricPattern::Triangle::upper;
}

std::unique_ptr<SpdSolver> make_spd_solver(std::string_view name, SymmetricPattern pattern) {
  if (name == "tridiagonal") return std::make_unique<TridiagonalSolver>(pattern);
  if (name == "block_tridiagonal") return std::make_unique<BlockTridiagonalSolver>(pattern);
  if (name == "eigen_ldlt") return std::make_unique<EigenLdltSolver>(pattern);
  if (name == "cholmod_simplicial")
    return std::make_unique<CholmodSolver>(std::move(pattern), false);
  if (name == "cholmod_supernodal")
    return std::make_unique<CholmodSolver>(std::move(pattern), true);
  if (name == "fixed_pattern") return std::make_unique<FixedPatternCholesky>(std::move(pattern));
  if (name == "fixed_pattern_single")
    return std::make_unique<MultifrontalCholesky<float>>(std::move(pattern));
  if (name == "fixed_pattern_mixed") return std::make_unique<MixedCholesky>(std::move(pattern));
  if (name == "line_cg") return std::make_unique<LineCgSolver>(std::move(pattern));
  if (name == "hybrid") return std::make_unique<HybridSpdSolver>(std::move(pattern));
  throw std::invalid_argument("no linear solver '" + std::string(name) + "'");
}

}  // namespace inextensible
