#include "solvers/linear/symmetric_pattern.h"

#include <algorithm>

namespace inextensible {

using Triangle = SymmetricPattern::Triangle;

int SymmetricPattern::place(int i, int j) const {
  if (triangle == (i < j ? Triangle::lower : Triangle::upper)) std::swap(i, j);
  const auto first = row_index.begin();
  return static_cast<int>(
      std::lower_bound(first + column_start[j], first + column_start[j + 1], i) - first);
}

bool SymmetricPattern::chain(int size) const {
  for (int j = 0; j < n; ++j) {
    const int block = j - j % size;
    const int low = triangle == Triangle::lower ? j : std::max(block - size, 0),
              high = triangle == Triangle::upper ? j : std::min(block + 2 * size, n) - 1;
    const int begin = column_start[j], last = column_start[j + 1] - 1;
    if (last - begin != high - low || row_index[begin] != low || row_index[last] != high)
      return false;
  }
  return n > 0 && n % size == 0;
}

SymmetricPattern pattern_of(int n, const Pairs& pairs, Triangle triangle) {
  std::vector<std::vector<int>> columns(n);
  for (int j = 0; j < n; ++j) columns[j].push_back(j);
  for (const auto& [i, j] : pairs) {
    const auto [low, high] = std::minmax(i, j);
    if (triangle != Triangle::lower) columns[high].push_back(low);
    if (triangle != Triangle::upper) columns[low].push_back(high);
  }
  SymmetricPattern pattern{n, triangle, {0}, {}};
  for (std::vector<int>& column : columns) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    pattern.row_index.insert(pattern.row_index.end(), column.begin(), column.end());
    pattern.column_start.push_back(pattern.entries());
  }
  return pattern;
}

SymmetricPattern in_blocks(const SymmetricPattern& pattern, int size) {
  Pairs pairs;
  for (int j = 0; j < pattern.n; ++j)
    for (int e = pattern.column_start[j]; e < pattern.column_start[j + 1]; ++e)
      for (int k = 0; k < size * size; ++k)
        pairs.emplace_back(size * pattern.row_index[e] + k % size, size * j + k / size);
  return pattern_of(size * pattern.n, pairs, pattern.triangle);
}

}  // namespace inextensible
