// A scene's cloth from a mesh of quads and triangles, with a fabric's forces in physical units.
#pragma once

#include "harness/scenes/cloth_mesh.h"
#include "harness/scenes/meshes.h"

namespace harness {

struct PinnedMesh {
  ClothMesh mesh;
  std::vector<char> held;  // of each vertex, whether it is pinned
};

// The scene's own parameters, and after them those that cloth_draft reads.
ParameterInfos with_cloth_parameters(const ParameterInfos& own, const ClothDefaults& cloth,
                                     double duration);

// The cloth is at rest, and unstretched, as the mesh lies. Sides of quads keep their length;
// diagonals of quads, and the other sides of triangles, are springs of the shear stiffness (each
// diagonal bears G (l gamma)^2 / 4 of a square sheared by gamma); yarns bend, straight at rest;
// all forces act as they are at the end of a step. Parameters: density (kg/m^2), gravity, shear
// (N/m), bending (N m), drag (N s/m^3), duration. Left to the caller: the scene's size, and what is
// not at rest there.
Draft cloth_draft(const PinnedMesh& cloth, const SceneParameters& p);

// Its vertices and constraints.
std::pair<int, int> count_cloth(const PinnedMesh& cloth);

}  // namespace harness
