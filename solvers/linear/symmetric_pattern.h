// The pattern of a sparse matrix that has an entry (j, i) wherever it has (i, j).
#pragma once

#include <utility>
#include <vector>

namespace inextensible {

// An n x n pattern, one triangle or both, in compressed columns with ascending row indices.
struct SymmetricPattern {
  enum class Triangle { lower, upper, both };
  int n = 0;
  Triangle triangle = Triangle::upper;
  std::vector<int> column_start;  // n + 1 entries
  std::vector<int> row_index;     // column_start[n] entries

  int entries() const { return static_cast<int>(row_index.size()); }
  // The place of a column's diagonal entry in one triangle: rows ascend, so it is the last of an
  // upper triangle's column and the first of a lower's.
  int diagonal(int column) const {
    return triangle == Triangle::upper ? column_start[column + 1] - 1 : column_start[column];
  }
  // The place of the entry (i, j); one triangle has (i, j) and (j, i) in one place.
  int place(int i, int j) const;
  // Whether it is block tridiagonal and holds every entry of its blocks of size x size.
  bool chain(int size) const;
};

using Pairs = std::vector<std::pair<int, int>>;

// The diagonal, and what these pairs couple; pairs may repeat.
SymmetricPattern pattern_of(int n, const Pairs& pairs, SymmetricPattern::Triangle triangle);

// The pattern with a block of size x size in place of each entry.
SymmetricPattern in_blocks(const SymmetricPattern& pattern, int size);

// An elimination order with little fill: order[i] is the row that comes i-th. The better of AMD and
// METIS nested dissection by CHOLMOD's own count of nonzeros, postordered.
std::vector<int> fill_reducing_order(const SymmetricPattern& pattern);

}  // namespace inextensible
