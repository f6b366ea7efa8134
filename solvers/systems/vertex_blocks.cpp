#include "solvers/systems/vertex_blocks.h"

#include <algorithm>

namespace inextensible {

SymmetricPattern vertex_graph(int n, const std::vector<Edge>& pairs) {
  std::vector<std::vector<int>> columns(n);
  for (int f = 0; f < n; ++f) columns[f].push_back(f);
  for (const auto [a, b] : pairs) columns[std::max(a, b)].push_back(std::min(a, b));
  SymmetricPattern graph;
  graph.n = n;
  graph.column_start.push_back(0);
  for (auto& column : columns) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    graph.row_index.insert(graph.row_index.end(), column.begin(), column.end());
    graph.column_start.push_back(graph.entries());
  }
  return graph;
}

SymmetricPattern lower_triangle(const SymmetricPattern& graph) {
  std::vector<std::vector<int>> columns(graph.n);
  for (int j = 0; j < graph.n; ++j) {
    for (int i = graph.column_start[j]; i < graph.column_start[j + 1]; ++i)
      columns[graph.row_index[i]].push_back(j);
  }
  SymmetricPattern lower;
  lower.n = graph.n;
  lower.triangle = SymmetricPattern::Triangle::lower;
  lower.column_start.push_back(0);
  for (const auto& column : columns) {
    lower.row_index.insert(lower.row_index.end(), column.begin(), column.end());
    lower.column_start.push_back(lower.entries());
  }
  return lower;
}

SymmetricPattern expand(const SymmetricPattern& graph, SymmetricPattern::Triangle triangle) {
  const std::size_t n = graph.n;
  std::vector<std::vector<int>> rows(n);  // per column of the result
  for (std::size_t j = 0; j < n; ++j) {
    for (int i = graph.column_start[j]; i < graph.column_start[j + 1]; ++i) {
      const int row = graph.row_index[i];
      if (triangle == SymmetricPattern::Triangle::upper) {
        rows[j].push_back(row);
      } else {
        rows[row].push_back(static_cast<int>(j));
      }
    }
  }
  SymmetricPattern pattern;
  pattern.n = 3 * graph.n;
  pattern.triangle = triangle;
  pattern.column_start.push_back(0);
  for (std::size_t j = 0; j < n; ++j) {
    for (int c = 0; c < 3; ++c) {
      for (const int row : rows[j]) {
        for (int r = 0; r < 3; ++r) {
          const bool diagonal = row == static_cast<int>(j);
          const bool stored =
              !diagonal || (triangle == SymmetricPattern::Triangle::upper ? r <= c : r >= c);
          if (stored) pattern.row_index.push_back(3 * row + r);
        }
      }
      pattern.column_start.push_back(pattern.entries());
    }
  }
  return pattern;
}

std::array<int, 3> block_begin(const SymmetricPattern& pattern, int i, int j) {
  const bool upper = pattern.triangle == SymmetricPattern::Triangle::upper;
  const int row = upper ? std::min(i, j) : std::max(i, j),
            column = upper ? std::max(i, j) : std::min(i, j);
  std::array<int, 3> begin{};
  for (int c = 0; c < 3; ++c) {
    const std::size_t col = 3 * column + c;
    const auto first = pattern.row_index.begin() + pattern.column_start[col];
    const auto last = pattern.row_index.begin() + pattern.column_start[col + 1];
    begin[c] = static_cast<int>(std::lower_bound(first, last, 3 * row) - pattern.row_index.begin());
  }
  return begin;
}

}  // namespace inextensible
