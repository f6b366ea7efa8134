// Rows and squares of vertices that scenes are made of.
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

// A scene whose problem is still open: pins, colliders and positions may change.
struct Draft {
  inextensible::ProblemParts parts;
  Scene scene;
};
// Throws std::invalid_argument for parts that make no problem.
Scene finished(Draft draft);

// n vertices along x, each constrained to the next, `mass` kg and `length` m in all; at rest, in
// one place. One mirror, the x-y plane. Parameters: n, length, mass, gravity, duration.
Draft vertex_row(const SceneParameters& p);

// n x n vertices on a horizontal square, centred over the origin at the height y (m), at rest; row
// i goes along z, column j along x, and vertex (i, j) has the number i n + j. Warp and weft are
// constrained; both diagonals of each quad are springs where `shear` is positive. Two mirrors: x
// and z reversed. Parameters: n, side, mass, gravity, shear, duration.
Draft vertex_square(const SceneParameters& p, double y);

// Bends every warp and weft yarn of a square: `rigidity` of the cloth, N m, each yarn's is that
// times the width that falls to it. Along the edges half a width.
void bend_yarns(Draft& square, const SceneParameters& p, double rigidity);

// Edge lengths of rows and squares, m.
double row_link(const SceneParameters& p);
double square_link(const SceneParameters& p);

// Vertices and constraints of the above.
std::pair<int, int> count_row(const SceneParameters& p);
std::pair<int, int> count_square(const SceneParameters& p);

}  // namespace harness
