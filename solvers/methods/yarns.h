// The yarns of woven cloth, found from its edges alone: a yarn goes on through the edge that
// lies opposite at a vertex, the one with which it shares no quad and no triangle.
#pragma once

#include <vector>

#include "solvers/problem/problem.h"

namespace inextensible {

// Edges of the problem in a row, each sharing a vertex with the next; no vertex comes twice.
struct Yarn {
  std::vector<int> vertices;  // one more than edges
  std::vector<int> edges;
  int color;  // yarns of one color share no vertex
};

// Every edge is in one yarn. Longest first within a color; colors from 0 on, the one with most
// edges first.
std::vector<Yarn> yarns_of(const Problem& problem);

}  // namespace inextensible
