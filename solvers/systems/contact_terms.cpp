#include "solvers/systems/contact_terms.h"

#include <algorithm>

namespace inextensible {

ContactTerms::ContactTerms(const EdgeConstraints& edges, int vertices,
                           const std::vector<int>& column_start,
                           const std::vector<int>& row_index) {
  struct End {
    int edge;
    double sign;
  };
  std::vector<std::vector<End>> ends(vertices);
  for (int k = 0; k < edges.count(); ++k) {
    ends[edges.a[k]].push_back({k, -1});
    ends[edges.b[k]].push_back({k, 1});
  }
  for (const std::vector<End>& here : ends) {
    first_.push_back(static_cast<int>(meetings_.size()));
    for (const End& column : here) {
      const auto begin = row_index.begin() + column_start[column.edge],
                 end = row_index.begin() + column_start[column.edge + 1];
      for (const End& row : here) {
        const auto found = std::lower_bound(begin, end, row.edge);
        if (found == end || *found != row.edge) continue;
        meetings_.push_back({row.edge, column.edge, static_cast<int>(found - row_index.begin()),
                             row.sign * column.sign});
      }
    }
  }
  first_.push_back(static_cast<int>(meetings_.size()));
}

void ContactTerms::subtract(const Contacts& contacts, const double* inverse_mass,
                            const Eigen::Matrix3Xd& left, const Eigen::Matrix3Xd& right,
                            double* values) const {
  const Contacts::Timing measured = contacts.timing();
  for (int c = 0; c < contacts.count(); ++c) {
    if (!contacts.holds(c)) continue;
    const int vertex = contacts.vertex(c);
    const Eigen::Vector3d normal = contacts.normal(c);
    for (int i = first_[vertex]; i < first_[vertex + 1]; ++i) {
      const Meeting& m = meetings_[i];
      values[m.entry] -= m.sign * inverse_mass[vertex] * normal.dot(left.col(m.row)) *
                         normal.dot(right.col(m.column));
    }
  }
}

}  // namespace inextensible
