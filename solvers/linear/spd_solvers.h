// The list of all linear solvers of spd_solver.h: a new one is its file and one row in
// spd_solvers.cpp.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "solvers/linear/spd_solver.h"

namespace inextensible {

enum class Takes { any, tridiagonal, block_tridiagonal };  // patterns; blocks are 3 x 3
enum class Precision { full, mixed };                      // of the factors

struct SpdSolverRow {
  const char* name;
  const char* summary;
  SymmetricPattern::Triangle triangle;  // that it reads
  Takes takes;
  bool fills;  // wants rows in an order of little fill; others do without or find their own
  Precision precision;
  std::unique_ptr<SpdSolver> (*make)(SymmetricPattern);
};

std::span<const SpdSolverRow> spd_solvers();
// Throws std::invalid_argument, naming it, if there is none.
const SpdSolverRow& spd_solver(std::string_view name);

// Throws std::invalid_argument for a name not in the list or a pattern that the solver cannot take.
std::unique_ptr<SpdSolver> make_spd_solver(std::string_view name, SymmetricPattern pattern);

}  // namespace inextensible
