// Degrees of freedom that constraints leave to a cloth.
#pragma once

#include <string>
#include <vector>

namespace harness {

// 3 per free vertex less the rank of J (SuiteSparseQR), at randomly displaced positions, so that
// the figure is that of a cloth in general position (claim C14).
struct Freedom {
  std::string mesh;  // "quads" or "triangles": all of their edges are constrained
  int vertices, constraints, rank, degrees_of_freedom;
};
// Both meshes of n x n vertices.
std::vector<Freedom> degrees_of_freedom(int n);

}  // namespace harness
