// The list of SPD solvers. inextensible::core has a shorter one (core.cpp).
#include "solvers/linear/multifrontal_cholesky.h"

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

std::span<const SpdSolverRow> spd_solvers() { return table; }

}  // namespace inextensible
