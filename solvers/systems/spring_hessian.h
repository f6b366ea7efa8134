// The matrix that springs and bending couple vertices in, blocks of 3 x 3, and where each spring
// and each bending stencil adds to it.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "solvers/systems/vertex_matrix.h"

namespace inextensible {

struct SpringHessian {
  // stiffness: EA of the edges, N. linear_solver: a name of make_spd_solver, or "auto".
  SpringHessian(const Problem& problem, double stiffness, std::string_view linear_solver);

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

  std::vector<Spring> springs;  // edges, then shear
  std::vector<Hinge> hinges;    // one a bending stencil
  VertexMatrix matrix;
  std::vector<double> free_mass;  // kg, in its order
  std::vector<Places> diagonal;   // one a free vertex
};

}  // namespace inextensible
