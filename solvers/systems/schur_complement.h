// The Schur complement J W J^T (m x m) of the constrained step (Goldenthal et al. 2007, eq. 7,
// without h^2).
//
// Entry (k, l) of two edges that share vertices is (sum over shared vertices v of s_kv s_lv w_v)
// u_k . u_l with s = +1 at an edge's b and -1 at its a. The bracket stays, so it is stored in the
// order of the matrix's own arrays: assembly is one pass that writes entries in their places.
#pragma once

#include "solvers/linear/symmetric_pattern.h"
#include "solvers/problem/contacts.h"
#include "solvers/problem/edge_constraints.h"

namespace inextensible {

class SchurComplement {
 public:
  SchurComplement(const EdgeConstraints& edges, int vertices, SymmetricPattern::Triangle triangle);

  const SymmetricPattern& pattern() const { return pattern_; }

  // From now on W is the diagonal of these numbers, one a vertex; at first it is the problem's.
  void weigh(const double* inverse_mass);

  // values[i] = entry i of J W J^T for the gradients u (3 x m); of J(left) W J(right)^T, which
  // wants both triangles.
  void assemble(const Eigen::Matrix3Xd& u, double* values) const { assemble(u, u, values); }
  void assemble(const Eigen::Matrix3Xd& left, const Eigen::Matrix3Xd& right, double* values) const;

  // What contacts take off: a vertex that is held by a plane of normal n moves within it only, so
  // that w (I - n n^T) takes the place of its w. The pattern stays. Friction is left out: what it
  // holds is a local matter.
  void subtract_contacts(const Contacts& contacts, const Eigen::Matrix3Xd& left,
                         const Eigen::Matrix3Xd& right, double* values) const;

 private:
  struct Meeting {  // at a vertex, of the edges of a row and a column
    int row, column, entry;
    double sign;
  };
  SymmetricPattern pattern_;
  std::vector<double> weight_;        // 1/kg, one an entry
  std::vector<double> inverse_mass_;  // 1/kg, one a vertex
  std::vector<int> first_;            // of a vertex's meetings; one more than vertices
  std::vector<Meeting> meetings_;
};

// The order of a problem's edges in which J W J^T factors with little fill.
std::vector<int> elimination_order(const Problem& problem);

}  // namespace inextensible
