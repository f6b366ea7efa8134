// The energy that a step of implicit springs lowers: with y = x^n + h v^n + h^2 g,
//   E(x) = 1/2 |x - y|_M^2 + h/2 |x - x^n|_D^2 + h^2 V(x),
// V of stretch and shear springs and of bending, D of drag; its gradient, and Newton's matrix.
//
// The matrix has each spring's Hessian projected to be positive semidefinite: a compressed spring's
// negative stiffness across its direction is dropped (Choi and Ko 2002, Teran et al. 2005). Stiff
// springs are almost constraints: their tension at an iterate is far off, that of the last
// linearization is not, and is the Hessian's stiffness across the spring (as primal-dual methods
// keep a multiplier).
#pragma once

#include <array>

#include "solvers/problem/contacts.h"
#include "solvers/systems/vertex_matrix.h"

namespace inextensible {

class SpringEnergy {
 public:
  SpringEnergy(const Problem& problem, double stiffness);  // EA of the edges, N

  // Begins a step of h seconds from `state` with the tensions of the last accepted step.
  void begin(const State& state, double h);
  void accept() { pull_before_.swap(pull_); }
  Positions& inertial() { return inertial_; }  // y

  double value(const Positions& x) const;
  // The gradient and, if wanted, the solver's matrix, at x. contacts: their vertices move within
  // their planes only; null: none.
  void assemble(const Positions& x, const Contacts* contacts, bool matrix);
  const Eigen::VectorXd& gradient() const { return gradient_; }
  // n . gradient of a contact, J s^2 / m / kg: what its plane bears.
  double reaction(int contact) const { return reaction_[contact]; }
  // Sets tensions to those of the springs, linearized at x, at `to`, over their vectors there.
  void predict_tension(const Positions& x, const Positions& to);

  const VertexMatrix& matrix() const { return matrix_; }
  int springs() const { return static_cast<int>(springs_.size()); }

 private:
  struct Spring {
    int a, b;                     // vertices
    int fa, fb;                   // their places among free vertices, -1 if pinned
    double rest, k;               // m, N/m
    std::array<int, 3> coupling;  // where each of its block's columns begins among the values
  };
  struct Hinge {                                 // a bending stencil's places
    std::array<int, 4> f;                        // among the free vertices, -1 if pinned
    std::array<std::array<int, 3>, 6> coupling;  // of the pairs 10, 20, 21, 30, 31, 32
  };
  struct Places {  // of a diagonal block's numbers among the matrix's values
    int xx, xy, yy, xz, yz, zz;
  };
  void add_block(const Spring& s, const std::array<double, 3>& d, double along, double transverse);
  void assemble_bending(const Positions& x, bool matrix);
  void hold_in_planes(const Contacts& contacts, bool matrix);

  const Problem& problem_;
  VertexMatrix matrix_;           // blocks of 3 x 3
  std::vector<Spring> springs_;   // edges, then shear
  std::vector<Hinge> hinges_;     // one a bending stencil
  std::vector<Places> diagonal_;  // one a free vertex
  double h_ = 0;                  // s
  Positions inertial_;
  Positions before_;  // x^n, with drag only
  Eigen::VectorXd gradient_;
  std::vector<double> reaction_;            // with contact inside only
  std::vector<double> pull_, pull_before_;  // N/m, tension over length; the last step's
};

}  // namespace inextensible
