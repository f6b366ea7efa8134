// Where the 3 x 3 blocks of a matrix lie that couples vertices: the Hessian of springs.
#pragma once

#include <array>
#include <vector>

#include "solvers/linear/symmetric_pattern.h"
#include "solvers/problem/problem.h"

namespace inextensible {

// Vertex blocks of the Hessian, one triangle, as vertex graph: column f holds itself and its
// neighbours of lower place.
SymmetricPattern vertex_graph(int n, const std::vector<Edge>& pairs);

// The same graph as the lower triangle.
SymmetricPattern lower_triangle(const SymmetricPattern& graph);

// The 3 x 3 block pattern of a vertex graph. The lower triangle is written as the transposed graph,
// column by column.
SymmetricPattern expand(const SymmetricPattern& graph, SymmetricPattern::Triangle triangle);

// Index of the first stored entry of block (i, j) in each of the three columns of the pattern's
// triangle.
std::array<int, 3> block_begin(const SymmetricPattern& pattern, int i, int j);

}  // namespace inextensible
