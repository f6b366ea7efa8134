// A problem's free vertices, ordered for little fill in a matrix that couples them, and its solver.
#pragma once

#include <string>

#include "solvers/linear/spd_solver.h"
#include "solvers/problem/problem.h"

namespace inextensible {

struct VertexMatrix {
  // coupled: pairs of vertices, of which those with a pinned one are left out. linear_solver: a
  // name of make_spd_solver, or "auto": that of chains where pairs join a vertex to the next, else
  // multifrontal. block: rows a vertex, 1 or 3.
  VertexMatrix(const Problem& problem, const Pairs& coupled, std::string_view wanted, int block);

  std::vector<int> vertex;   // the free ones, in elimination order
  std::vector<int> place;    // of each vertex among these, -1 if pinned
  SymmetricPattern pattern;  // in blocks
  std::string linear_solver;
  std::unique_ptr<SpdSolver> solver;
};

}  // namespace inextensible
