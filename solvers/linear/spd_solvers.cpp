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
    {"tridiagonal", upper, Takes::tridiagonal, make_tridiagonal},
    {"block_tridiagonal", upper, Takes::block_tridiagonal, make_block_tridiagonal},
    {"multifrontal", lower, Takes::any, make<MultifrontalCholesky<double>>},
    {"multifrontal_mixed", lower, Takes::any, make<MixedCholesky>, Precision::mixed},
    {"cholmod_supernodal", lower, Takes::any, make_cholmod_supernodal},
};

}  // namespace

std::span<const SpdSolverRow> spd_solvers() { return table; }

}  // namespace inextensible
