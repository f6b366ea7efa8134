#include "solvers/systems/schur_complement.h"

#include <algorithm>

namespace inextensible {
namespace {

struct Entry {
  int row;
  double weight;
};

// Calls add(column, entries) for each column of the full matrix, entries sorted by row and without
// duplicates.
template <class Add>
void for_each_column(const EdgeConstraints& edges, int vertices, Add add) {
  std::vector<std::vector<int>> incident(vertices);
  for (int k = 0; k < edges.count(); ++k) {
    incident[edges.a[k]].push_back(k);
    incident[edges.b[k]].push_back(k);
  }
  std::vector<Entry> column;
  for (int l = 0; l < edges.count(); ++l) {
    column.clear();
    for (const bool at_b : {false, true}) {
      const int vertex = at_b ? edges.b[l] : edges.a[l];
      const double w = at_b ? edges.wb[l] : edges.wa[l];
      for (const int k : incident[vertex]) {
        const bool same_end = (edges.b[k] == vertex) == at_b;
        column.push_back({k, same_end ? w : -w});
      }
    }
    std::sort(column.begin(), column.end(),
              [](const Entry& p, const Entry& q) { return p.row < q.row; });
    std::size_t size = 0;
    for (const Entry& entry :
         column) {  // edges that share both ends (and the diagonal) appear twice: add up
      if (size > 0 && column[size - 1].row == entry.row) {
        column[size - 1].weight += entry.weight;
      } else {
        column[size++] = entry;
      }
    }
    column.resize(size);
    add(l, column);
  }
}

double dot3(const double* p, const double* q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

}  // namespace

SchurComplement::SchurComplement(const EdgeConstraints& edges, int vertices,
                                 SymmetricPattern::Triangle triangle) {
  pattern_.n = edges.count();
  pattern_.triangle = triangle;
  pattern_.column_start.push_back(0);
  const bool upper = triangle == SymmetricPattern::Triangle::upper;
  for_each_column(edges, vertices, [&](int l, const std::vector<Entry>& column) {
    for (const Entry& entry : column) {
      if (upper ? entry.row > l : entry.row < l) continue;
      pattern_.row_index.push_back(entry.row);
      weight_.push_back(entry.weight);
    }
    pattern_.column_start.push_back(static_cast<int>(pattern_.row_index.size()));
  });
}

void SchurComplement::assemble(const Eigen::Matrix3Xd& u, double* values) const {
  const double* g = u.data();
  const int* row = pattern_.row_index.data();
  const double* w = weight_.data();
  for (int l = 0; l < pattern_.n; ++l) {
    const double* ul = g + 3 * l;
    const int end = pattern_.column_start[l + 1];
    for (int i = pattern_.column_start[l]; i < end; ++i) {
      values[i] = w[i] * dot3(g + 3 * row[i], ul);
    }
  }
}

void SchurComplement::scale_diagonal(double factor, double* values) const {
  for (int l = 0; l < pattern_.n; ++l) values[pattern_.diagonal(l)] *= factor;
}

UnsymmetricSchurComplement::UnsymmetricSchurComplement(const EdgeConstraints& edges, int vertices) {
  column_start.push_back(0);
  for_each_column(edges, vertices, [&](int, const std::vector<Entry>& column) {
    for (const Entry& entry : column) {
      row_index.push_back(entry.row);
      weight.push_back(entry.weight);
    }
    column_start.push_back(static_cast<int>(row_index.size()));
  });
}

void UnsymmetricSchurComplement::assemble(const Eigen::Matrix3Xd& left,
                                          const Eigen::Matrix3Xd& right, double* values) const {
  for (std::size_t l = 0; l + 1 < column_start.size(); ++l) {
    const double* ul = right.data() + 3 * l;
    for (int i = column_start[l]; i < column_start[l + 1]; ++i) {
      values[i] = weight[i] * dot3(left.data() + 3 * row_index[i], ul);
    }
  }
}

}  // namespace inextensible
