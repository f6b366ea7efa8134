// One closed surface of a collider: signed distance from the nearest triangle, with the sign from
// angle-weighted pseudonormals (Baerentzen and Aanaes 2005).
//
// A uniform grid over the mesh's box lists for each cell every triangle that is nearest to some
// point of the cell (those no farther from its centre than the nearest one plus its diagonal),
// found by refining an octree. Cells wholly outside are empty. Of a convex mesh planes are enough:
// a point is inside if it is behind all of them, and its nearest point is its foot on the plane
// that it is least behind, or most in front of; cells list only planes that can be this one.
// A plane that a point is not behind, of a triangle or of the box, shows that it is outside: the
// one that did so last is asked first, of several vertices side by side.
#pragma once

#include <array>
#include <span>

#include "solvers/problem/collider.h"

namespace inextensible {

struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;      // m
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from outside; closed
};

// The sides of triangles: 3 f + i goes from corner i of triangle f to the next one.
struct TriangleSides {
  std::vector<int> twin;  // of each, the same side of the other triangle there
  int a, b, faces;  // the first side, from a to b, with another number of faces than 2; else 2
};
TriangleSides sides_of(const std::vector<std::array<int, 3>>& triangles);

// The piece that each vertex is of, from 0 on: those of a triangle are of one.
std::vector<int> pieces_of(std::size_t vertices, const std::vector<std::array<int, 3>>& triangles);

class ClosedSurface {
 public:
  using Memory = Collider::Memory;

  // Throws std::invalid_argument for a mesh that is not closed.
  explicit ClosedSurface(TriangleMesh mesh);

  // As Collider's, but `planes` are added; what is remembered is in rows from first_row on.
  void find(const Eigen::Matrix3Xd& x, const std::vector<double>& inverse_mass, double depth,
            Eigen::Index first_row, Memory& memory, std::vector<ContactPlane>& planes,
            WorkCounters& work) const;
  bool plane_at(const Eigen::Vector3d& p, ContactPlane& plane, WorkCounters& work) const;

  struct Nearest {
    Eigen::Vector3d point;   // on the mesh, m
    Eigen::Vector3d normal;  // outward pseudonormal there, unit
    double signed_distance;  // m, negative inside
  };
  // Exact; inside the mesh's box by way of the grid.
  Nearest nearest(const Eigen::Vector3d& p) const;
  // The slow, obvious route: over all triangles. What the tests compare with.
  Nearest nearest_by_all(const Eigen::Vector3d& p) const { return nearest_among(lists_[deep], p); }

 private:
  struct Closest {  // on one triangle
    Eigen::Vector3d point;
    double squared;
    int feature;  // 0 face; 1, 2, 3 edge after corner feature - 1; 4, 5, 6 corner feature - 4
  };
  int triangles() const { return static_cast<int>(mesh_.triangles.size()); }
  Closest closest(int triangle, const Eigen::Vector3d& p) const;
  Nearest nearest_among(std::span<const int> triangles, const Eigen::Vector3d& p) const;
  void find_pseudonormals();
  void check_orientation();
  void lay_out_grid();
  using Balls = Eigen::ArrayX4d;  // around triangles: centre and radius
  Balls balls_around_triangles() const;
  void refine(const Eigen::Vector3i& cell, int size, const std::vector<int>& candidates,
              const Balls& balls);
  void refine_planes(const Eigen::Vector3i& cell, int size, const std::vector<int>& candidates);
  void fill(const Eigen::Vector3i& cell, int size, int list);
  // Whether p, in a cell that is not outside, is deeper than `depth` inside the mesh; if so,
  // `plane` keeps it out. Of a convex mesh this row of `memory` is then the plane that shows that
  // it is not, or will once it has pushed it out.
  bool touches(std::span<const int> list, const Eigen::Vector3d& p, double depth, Eigen::Index row,
               Memory& memory, ContactPlane& plane) const;
  // If p is outside the box, a plane of the box that p is in front of.
  void show_outside(const Eigen::Vector3d& p, Memory::RowXpr witness) const;
  // The triangle of the list whose plane p is least behind, or most in front of.
  int least_behind(std::span<const int> list, const Eigen::Vector3d& p, double& distance) const;
  int cell_at(const Eigen::Vector3d& p) const;  // of cell_; outside where p is outside the box
  std::size_t cell_index(const Eigen::Vector3i& cell) const;

  // Lists of numbers one behind the other, each after its length.
  class Lists {
   public:
    int add(const std::vector<int>& list) {  // returns what finds it
      const auto at = static_cast<int>(numbers_.size());
      numbers_.push_back(static_cast<int>(list.size()));
      numbers_.insert(numbers_.end(), list.begin(), list.end());
      return at;
    }
    std::span<const int> operator[](int at) const {
      return {numbers_.data() + at + 1, static_cast<std::size_t>(numbers_[at])};
    }

   private:
    std::vector<int> numbers_;
  };

  static constexpr int resolution = 32;  // cells an axis, a power of two
  static constexpr int outside = -1;     // a cell without a list
  static constexpr int deep = 0;         // the list of all triangles
  TriangleMesh mesh_;
  bool convex_ = false;
  std::vector<std::array<Eigen::Vector3d, 7>> pseudonormal_;  // per triangle, by feature
  Eigen::Vector3d low_, cell_size_, inverse_cell_size_;
  std::vector<int> cell_;                   // what finds its list, or outside
  Lists lists_;                             // triangles
  std::vector<Eigen::RowVector4d> planes_;  // of the faces: normal and offset
};

}  // namespace inextensible
