#include "solvers/linear/symmetric_pattern.h"

namespace inextensible {
namespace {

// Whether every entry lies in a block of `size` rows and columns that is on the diagonal or beside
// it.
bool near_diagonal(const SymmetricPattern& pattern, int size) {
  for (int column = 0; column < pattern.n; ++column) {
    for (int i = pattern.column_start[column]; i < pattern.column_start[column + 1]; ++i) {
      const int distance = pattern.row_index[i] / size - column / size;
      if (distance < -1 || distance > 1) return false;
    }
  }
  return true;
}

}  // namespace

bool SymmetricPattern::tridiagonal() const { return near_diagonal(*this, 1); }

bool SymmetricPattern::block_tridiagonal() const { return n % 3 == 0 && near_diagonal(*this, 3); }

}  // namespace inextensible
