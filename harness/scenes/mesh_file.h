// Meshes in Wavefront's OBJ format, as their exporters mean them.
#pragma once

#include <string>

#include "solvers/problem/problem.h"

namespace harness {

struct MeshFile {
  struct Face {
    std::vector<int> corners;       // in turn
    int line;                       // of the file, from 1
    std::vector<int> texture = {};  // the corners' places in the texture; empty: not all have one
  };
  std::string path;
  std::vector<Eigen::Vector3d> vertices;       // in the file's unit
  std::vector<Face> faces;                     // in the order of the file
  std::vector<std::array<int, 2>> ropes = {};  // segments of the elements "l"
  std::vector<Eigen::Vector2d> texture = {};   // of the elements "vt": u, v
  int sewn = 0;                                // lines that sew() has closed

  // "'m.obj', face 12 (line 80)", as the file counts.
  std::string name(const Face& face) const;
};

// Vertices, faces and lines. A byte order mark, comments after the data and lines continued by a
// backslash are read as such; materials, curves and groups are left out.
// Throws UsageError, naming file and line, for any other keyword, numbers that are none, corners
// without a vertex, and files without a face or line.
MeshFile read_mesh_file(const std::string& path);

// Wavefront OBJ: triangles, or the edges as lines where there are none. Coordinates are read back
// to the last bit; with `digits` they are rounded.
std::string obj_text(const Eigen::Matrix3Xd& x, const std::vector<std::array<int, 3>>& triangles,
                     const std::vector<inextensible::Edge>& edges, int digits = 17);

// Corners closer than `distance` (in the file's unit) become one vertex, the first of them.
void weld(MeshFile& file, double distance);

// Lines of no length between faces sew: their ends become one vertex.
void sew(MeshFile& file);

// Faces without those that have the corners of an earlier one. Throws UsageError, naming the face,
// for corners in one place or on one line, and for quads that cross themselves.
std::vector<MeshFile::Face> distinct_faces(const MeshFile& file);

}  // namespace harness
