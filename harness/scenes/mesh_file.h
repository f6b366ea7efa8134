// Meshes in Wavefront's OBJ format, as their exporters mean them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace harness {

struct MeshFile {
  struct Face {
    std::vector<int> corners;  // in turn
    int line;                  // of the file, from 1
  };
  std::string path;
  std::vector<Eigen::Vector3d> vertices;  // in the file's unit
  std::vector<Face> faces;                // in the order of the file

  // "'m.obj', face 12 (line 80)", as the file counts.
  std::string name(const Face& face) const;
};

// Vertices and faces. A byte order mark, comments after the data and lines continued by a
// backslash are read as such; lines, curves, materials and groups are left out. Throws UsageError,
// naming file and line, for other keywords, bad numbers, corners without a vertex, and no face.
MeshFile read_mesh_file(const std::string& path);

// Faces without those that have the corners of an earlier one. Throws UsageError, naming the face,
// for corners in one place or on one line, quads that cross themselves, and sides of more than two
// faces.
std::vector<MeshFile::Face> distinct_faces(const MeshFile& file);

}  // namespace harness
