#include "solvers/systems/schur_complement.h"

namespace inextensible {
namespace {

double dot3(const double* p, const double* q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

}  // namespace

SchurComplement::SchurComplement(const EdgeConstraints& edges, int vertices,
                                 SymmetricPattern::Triangle triangle)
    : inverse_mass_(vertices) {
  struct End {
    int edge;
    double sign;
  };
  std::vector<std::vector<End>> ends(vertices);
  for (int k = 0; k < edges.count(); ++k) {
    ends[edges.a[k]].push_back({k, -1});
    ends[edges.b[k]].push_back({k, 1});
    inverse_mass_[edges.a[k]] = edges.wa[k];
    inverse_mass_[edges.b[k]] = edges.wb[k];
  }
  Pairs pairs;
  for (const std::vector<End>& here : ends)
    for (const End& column : here)
      for (const End& row : here) pairs.emplace_back(row.edge, column.edge);
  pattern_ = pattern_of(edges.count(), pairs, triangle);
  for (const std::vector<End>& here : ends) {
    first_.push_back(static_cast<int>(meetings_.size()));
    for (const auto& [l, sign_l] : here)
      for (const auto& [k, sign_k] : here) {
        using enum SymmetricPattern::Triangle;
        if (k != l && triangle == (k < l ? lower : upper)) continue;
        meetings_.push_back({k, l, pattern_.place(k, l), sign_k * sign_l});
      }
  }
  first_.push_back(static_cast<int>(meetings_.size()));
  weigh(std::vector(inverse_mass_).data());
}

void SchurComplement::weigh(const double* inverse_mass) {
  inverse_mass_.assign(inverse_mass, inverse_mass + inverse_mass_.size());
  weight_.assign(pattern_.entries(), 0);
  for (std::size_t v = 0; v < inverse_mass_.size(); ++v)
    for (int i = first_[v]; i < first_[v + 1]; ++i)
      weight_[meetings_[i].entry] += meetings_[i].sign * inverse_mass_[v];
}

void SchurComplement::assemble(const Eigen::Matrix3Xd& left, const Eigen::Matrix3Xd& right,
                               double* values) const {
  const double* g = left.data();
  const int* row = pattern_.row_index.data();
  const double* w = weight_.data();
  for (int l = 0; l < pattern_.n; ++l) {
    const double* ul = right.data() + 3 * l;
    const int end = pattern_.column_start[l + 1];
    for (int i = pattern_.column_start[l]; i < end; ++i)
      values[i] = w[i] * dot3(g + 3 * row[i], ul);
  }
}

void SchurComplement::subtract_contacts(const Contacts& contacts, const Eigen::Matrix3Xd& left,
                                        const Eigen::Matrix3Xd& right, double* values) const {
  const Contacts::Timing measured = contacts.timing();
  for (int c = 0; c < contacts.count(); ++c) {
    if (!contacts.holds(c)) continue;
    const int vertex = contacts.vertex(c);
    const Eigen::Vector3d& normal = contacts.normal(c);
    for (int i = first_[vertex]; i < first_[vertex + 1]; ++i) {
      const Meeting& m = meetings_[i];
      values[m.entry] -= m.sign * inverse_mass_[vertex] * normal.dot(left.col(m.row)) *
                         normal.dot(right.col(m.column));
    }
  }
}

std::vector<int> elimination_order(const Problem& problem) {
  const EdgeConstraints natural(problem, 1);
  return fill_reducing_order(
      SchurComplement(natural, problem.vertices(), SymmetricPattern::Triangle::upper).pattern());
}

}  // namespace inextensible
