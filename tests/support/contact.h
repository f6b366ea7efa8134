// Obstacles and what stands on them, for tests of contact.
#pragma once

#include "solvers/problem/contacts.h"

namespace inextensible::testing {

// All that lies behind a plane.
struct Ground final : Collider {
  Ground(const Eigen::Vector3d& along, double at, double friction)
      : normal(along.normalized()), offset(at), friction_(friction) {}

  void find(const Eigen::Matrix3Xd& x, const std::vector<double>& inverse_mass, double depth,
            Memory& /*memory*/, std::vector<ContactPlane>& planes,
            WorkCounters& /*work*/) const override {
    planes.clear();
    for (Eigen::Index v = 0; v < x.cols(); ++v)
      if (inverse_mass[static_cast<std::size_t>(v)] > 0 && normal.dot(x.col(v)) - offset < -depth)
        planes.push_back({static_cast<int>(v), normal, offset});
  }
  bool plane_at(const Eigen::Vector3d& /*p*/, ContactPlane& plane,
                WorkCounters& /*work*/) const override {
    plane.normal = normal;
    plane.offset = offset;
    return true;
  }
  double friction() const override { return friction_; }
  int triangles() const override { return 0; }

  Eigen::Vector3d normal;
  double offset, friction_;
};

// Points without edges, of mass 1, beside an obstacle.
inline Problem points(int n, std::shared_ptr<const Collider> collider, bool contact_inside = true) {
  ProblemParts parts;
  parts.contact_inside = contact_inside;
  parts.mass.assign(static_cast<std::size_t>(n), 1.0);
  parts.collider = std::move(collider);
  return Problem(std::move(parts));
}

}  // namespace inextensible::testing
