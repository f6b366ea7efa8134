// Degrees of freedom that constraints leave to a cloth.
#pragma once

#include <string>
#include <vector>

namespace harness {

// 3 per free vertex less the rank of J (SuiteSparseQR), at randomly displaced positions, so that
// the figure is that of a cloth in general position (claim C14).
struct Freedom {
  // "quads" or "triangles": all of their edges are constrained; "midpoints": edges between the
  // midpoints of triangles' edges.
  std::string mesh;
  int vertices;  // of quads and triangles
  int constraints, rank, degrees_of_freedom;
};
// The three meshes of n x n vertices.
std::vector<Freedom> degrees_of_freedom(int n);

}  // namespace harness
