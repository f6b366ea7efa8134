// Wavefront OBJ: the vertices and faces of a mesh, and nothing else of what a file may hold.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace harness {

struct MeshFile {
  std::vector<Eigen::Vector3d> vertices;  // in the file's unit
  std::vector<std::vector<int>> faces;    // corners in the order of the file
};

// Throws UsageError, naming file and line, for what is no OBJ file or has no face.
MeshFile read_mesh_file(const std::string& path);

}  // namespace harness
