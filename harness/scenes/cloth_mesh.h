// A scene's cloth from a mesh of quads and triangles: cut finer, which of their sides are warp and
// weft, and a fabric's forces in physical units.
#pragma once

#include "harness/scenes/mesh_file.h"
#include "harness/scenes/meshes.h"

namespace harness {

struct ClothMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 4>> quads;      // corners in turn
  std::vector<std::array<int, 3>> triangles;  // what is left
  std::vector<std::array<int, 2>> ropes = {};
  std::vector<int> in_file = {};  // of each vertex, its place in the file; empty once it is refined
  // Whether the first side of each quad runs along the texture's u, which is warp; empty: unknown.
  std::vector<char> along_u = {};
  std::vector<char> held = {};    // of each vertex, whether a scene pins it
  std::vector<char> loaded = {};  // whether a weight hangs there
  // Vertices are the midpoints of another mesh's sides, and triangles join those of one triangle.
  bool medial = false;
};

// Quads of a file's faces: triangles are joined to quads where two make one whose angles are within
// `most_oblique` of right ones, the best first, or whose sides run along the texture's axes, where
// that makes at least half as many quads. Faces of more corners are fans of triangles.
// Lines are ropes. Vertices that neither has are left out. With `triangles` nothing is joined.
// Throws UsageError for what distinct_faces() refuses, and for sides of more than two faces.
ClothMesh cloth_of(const MeshFile& file, bool triangles = false);

// The piece that each vertex is of, from 0 on: faces and ropes that share a vertex are of one.
std::vector<int> pieces_of(const ClothMesh& mesh);

// Each side cut into n.
ClothMesh refined(const ClothMesh& mesh, int n);

// Triangles by the midpoints of their sides. The triangles of midpoints keep their shape, share
// corners only, and so leave a cloth three degrees of freedom a vertex, where triangles that keep
// all their sides lock (English and Bridson 2008, "Animating Developable Surfaces using
// Nonconforming Elements"). A midpoint is held, or loaded, if an end of its side is.
ClothMesh midpoints_of(const ClothMesh& mesh);

// ---- The scene ----

// The scene's own parameters, and after them those that cloth_draft reads.
ParameterInfos with_cloth_parameters(const ParameterInfos& own, const ClothDefaults& cloth,
                                     double duration);

// The cloth is at rest, and unstretched, as the mesh lies. Sides of quads and ropes keep their
// length; diagonals of quads, and the other sides of triangles, are springs of the shear stiffness
// (each diagonal bears G (l gamma)^2 / 4 of a square sheared by gamma); yarns bend, straight at
// rest, and triangles of midpoints against each other, flat at rest; all forces act as they are at
// the end of a step. Parameters: density (kg/m^2), gravity, shear (N/m), bending (N m), drag (N
// s/m^3), duration, line_density (kg/m) if there are ropes, and weft_bending and weft_limit (of
// weft over that of warp) if the texture tells them apart. Left to the caller: the scene's size,
// and what is not at rest there.
Draft cloth_draft(const ClothMesh& mesh, const SceneParameters& p);

// Its vertices and constraints.
std::pair<int, int> count_cloth(const ClothMesh& mesh);

}  // namespace harness
