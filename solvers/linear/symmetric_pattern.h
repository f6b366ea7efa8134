// The pattern of a sparse symmetric matrix.
#pragma once

#include <vector>

namespace inextensible {

// The pattern of a symmetric n x n matrix: one triangle in compressed columns, row indices
// ascending.
struct SymmetricPattern {
  enum class Triangle { lower, upper };
  int n = 0;
  Triangle triangle = Triangle::upper;
  std::vector<int> column_start;  // n + 1 entries
  std::vector<int> row_index;     // column_start[n] entries

  int entries() const { return static_cast<int>(row_index.size()); }
  // Whether every entry lies on the diagonal or beside it.
  bool tridiagonal() const;
  // The same of 3 x 3 blocks.
  bool block_tridiagonal() const;
  // The place of a column's diagonal entry: rows ascend, so it is the last of an upper triangle's
  // column and the first of a lower's.
  int diagonal(int column) const {
    return triangle == Triangle::upper ? column_start[column + 1] - 1 : column_start[column];
  }
};

// An elimination order with little fill: order[i] is the row that comes i-th. The better of AMD and
// METIS nested dissection by CHOLMOD's own count of nonzeros, postordered.
std::vector<int> fill_reducing_order(const SymmetricPattern& pattern);

}  // namespace inextensible
