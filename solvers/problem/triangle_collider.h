// Collision of vertices against closed triangle meshes. Each piece of the mesh has a grid of its
// own, so that a floor does not make the cells of a body on it coarse; of pieces that overlap a
// vertex leaves that which it is deepest in.
#pragma once

#include <memory>

#include "solvers/problem/closed_surface.h"

namespace inextensible {

// Icosahedron whose faces are split in four `subdivisions` times and pushed out to the sphere: 20 *
// 4^subdivisions faces. Mirror symmetric in all three coordinate planes through its centre.
TriangleMesh icosphere(const Eigen::Vector3d& centre, double radius, int subdivisions);

// Adds the block between two opposite corners.
void add_block(TriangleMesh& mesh, const Eigen::Vector3d& low, const Eigen::Vector3d& high);

class TriangleCollider final : public Collider {
 public:
  // friction: Coulomb coefficient. Throws std::invalid_argument for a mesh that is not closed.
  TriangleCollider(TriangleMesh mesh, double friction);
  // The same mesh with another friction, and the same grids.
  TriangleCollider(const TriangleCollider& same, double friction)
      : mesh_(same.mesh_), friction_(friction), pieces_(same.pieces_) {}

  Memory nothing_of(int vertices) const override;
  void find(const Eigen::Matrix3Xd& x, const std::vector<double>& inverse_mass, double depth,
            Memory& memory, std::vector<ContactPlane>& planes, WorkCounters& work) const override;
  bool plane_at(const Eigen::Vector3d& p, ContactPlane& plane, WorkCounters& work) const override;
  double friction() const override { return friction_; }
  int triangles() const override { return static_cast<int>(mesh_.triangles.size()); }
  const TriangleMesh& mesh() const { return mesh_; }

  // The nearest point of the piece of least signed distance.
  using Nearest = ClosedSurface::Nearest;
  Nearest nearest(const Eigen::Vector3d& p) const;
  Nearest nearest_by_all(const Eigen::Vector3d& p) const;

 private:
  TriangleMesh mesh_;
  double friction_;
  std::shared_ptr<const std::vector<ClosedSurface>> pieces_;
};

}  // namespace inextensible
