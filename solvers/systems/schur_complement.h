// The Schur complement J W J^T (m x m) of the constrained step (Goldenthal et al. 2007, eq. 7,
// without h^2).
//
// Entry (k, l) of two edges that share vertices is (sum over shared vertices v of s_kv s_lv w_v)
// u_k . u_l with s = +1 at an edge's b and -1 at its a. The bracket never changes, so it is stored
// once, in the order of the matrix's own arrays: assembly is one pass that writes each entry where
// the factorization reads it.
#pragma once

#include "solvers/linear/spd_solver.h"
#include "solvers/problem/edge_constraints.h"

namespace inextensible {

class SchurComplement {
 public:
  SchurComplement(const EdgeConstraints& edges, int vertices, SymmetricPattern::Triangle triangle);

  const SymmetricPattern& pattern() const { return pattern_; }

  // values[i] = entry i of J W J^T for the gradients u (3 x m).
  void assemble(const Eigen::Matrix3Xd& u, double* values) const;

  void scale_diagonal(double factor, double* values) const;

 private:
  SymmetricPattern pattern_;
  std::vector<double> weight_;  // 1/kg, one an entry
};

// The pattern of J(left) W J(right)^T in full, for directions taken at two different positions
// (SHAKE).
struct UnsymmetricSchurComplement {
  UnsymmetricSchurComplement(const EdgeConstraints& edges, int vertices);
  void assemble(const Eigen::Matrix3Xd& left, const Eigen::Matrix3Xd& right, double* values) const;

  std::vector<int> column_start, row_index;
  std::vector<double> weight;
};

}  // namespace inextensible
