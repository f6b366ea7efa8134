// What inextensible::core has in place of all that needs CHOLMOD, UMFPACK or BLAS: shorter lists. A
// method that asks for a factorization which is not there throws std::invalid_argument as it is
// made.
#include <stdexcept>

#include "solvers/methods/backend.h"

namespace inextensible {

std::unique_ptr<SpdSolver> make_tridiagonal(SymmetricPattern pattern);
std::unique_ptr<SpdSolver> make_block_tridiagonal(SymmetricPattern pattern);

std::span<const SpdSolverRow> spd_solvers() {
  constexpr auto upper = SymmetricPattern::Triangle::upper;
  static constexpr SpdSolverRow table[] = {
      {"tridiagonal", upper, Takes::tridiagonal, make_tridiagonal},
      {"block_tridiagonal", upper, Takes::block_tridiagonal, make_block_tridiagonal}};
  return table;
}

std::vector<int> fill_reducing_order(const SymmetricPattern& /*pattern*/) {
  throw std::invalid_argument("inextensible::core factors no matrices but those of chains");
}

// Rows without a name, which the registry leaves out.
Backend icd_row() { return {}; }
Backend shake_row() { return {}; }
Backend rattle_row() { return {}; }

}  // namespace inextensible
