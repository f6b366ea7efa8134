// Quads and triangles of cloth, cut finer, and which of their sides are warp and weft.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace harness {

// What a file holds of a mesh.
struct MeshFile {
  std::vector<Eigen::Vector3d> vertices;  // in the file's unit
  std::vector<std::vector<int>> faces;    // corners in the order of the file
};

struct ClothMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 4>> quads;      // corners in turn
  std::vector<std::array<int, 3>> triangles;  // what is left
};

// Quads of a file's faces: triangles are joined to quads where two make one whose angles are within
// `most_oblique` of right ones, the best first. Vertices that no face has are left out. Throws
// UsageError, naming file and vertices (counted from 1), for faces of more corners, sides without
// length, and sides of more than two faces.
ClothMesh cloth_of(const MeshFile& file, const std::string& path);
inline constexpr double most_oblique = 50;  // degrees

// Each side cut into n.
ClothMesh refined(const ClothMesh& mesh, int n);

using Side = std::pair<int, int>;  // the lower vertex first
std::vector<Side> sides_of_quads(const ClothMesh& mesh);
// Sides of triangles that no quad has.
std::vector<Side> sides_of_triangles(const ClothMesh& mesh);

// Yarns: three vertices in a row, the middle one of whose four sides at quads two are opposite
// each other. Where yarns end or five sides meet there are none.
std::vector<std::array<int, 3>> yarns_of(const ClothMesh& mesh);

// Each vertex's share of the faces around it.
std::vector<double> areas(const ClothMesh& mesh);

}  // namespace harness
