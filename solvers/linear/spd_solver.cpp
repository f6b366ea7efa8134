#include "inextensible/linear/spd_solver.h"

#include <stdexcept>
#include <string>

#include "inextensible/linear/block_tridiagonal.h"
#include "inextensible/linear/cholmod.h"
#include "inextensible/linear/eigen_ldlt.h"
#include "inextensible/linear/hybrid.h"
#include "inextensible/linear/line_cg.h"
#include "inextensible/linear/mixed_cholesky.h"
#include "inextensible/linear/multifrontal_cholesky.h"
#include "inextensible/linear/tridiagonal.h"

namespace inextensible {

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
