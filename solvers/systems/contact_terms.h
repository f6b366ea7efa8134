// What contacts take off J W J^T: a vertex that is held by a plane of normal n moves within it
// only, so that w (I - n n^T) takes the place of its w. Two edges that meet there, with ends of
// signs s, lose s_k s_l w (u_k . n) (u_l . n) of their entry; the pattern stays. Friction is left
// out: what it holds is a local matter.
#pragma once

#include <vector>

#include "solvers/problem/contacts.h"
#include "solvers/problem/edge_constraints.h"

namespace inextensible {

class ContactTerms {
 public:
  // For a matrix with these compressed columns, rows ascending in each: a triangle of J W J^T, or
  // the whole of J(left) W J(right)^T.
  ContactTerms(const EdgeConstraints& edges, int vertices, const std::vector<int>& column_start,
               const std::vector<int>& row_index);

  // left and right: 3 x m gradients. inverse_mass: of each vertex, as in the matrix.
  void subtract(const Contacts& contacts, const double* inverse_mass, const Eigen::Matrix3Xd& left,
                const Eigen::Matrix3Xd& right, double* values) const;

 private:
  struct Meeting {  // at a vertex, of the edges of a row and a column
    int row, column, entry;
    double sign;
  };
  std::vector<int> first_;  // of a vertex's meetings; one more than vertices
  std::vector<Meeting> meetings_;
};

}  // namespace inextensible
