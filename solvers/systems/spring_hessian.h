// The matrix that springs and bending couple vertices in: blocks of 3 x 3 on the free vertices,
// numbered so that it factors with little fill, and where each spring and each bending stencil adds
// to it.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/linear/spd_solver.h"
#include "solvers/problem/problem.h"

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

  std::vector<Spring> springs;    // edges, then shear
  std::vector<Hinge> hinges;      // one a bending stencil
  std::vector<int> free_vertex;   // in elimination order
  std::vector<int> free_place;    // of each vertex among these, -1 if pinned
  std::vector<double> free_mass;  // kg
  std::vector<Places> diagonal;   // one a free vertex
  std::string linear_solver;
  std::size_t entries = 0;  // of the matrix
  std::unique_ptr<SpdSolver> solver;

 private:
  Pairs coupled_pairs(const Problem& problem) const;
  void order_vertices(const Pairs& pairs);
  void locate_blocks(const Problem& problem, const SymmetricPattern& pattern);
};

}  // namespace inextensible
