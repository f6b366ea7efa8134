// Obstacles and what stands on them, for tests of contact.
#pragma once

#include <memory>

#include "solvers/problem/contacts.h"

namespace inextensible::testing {

// All that lies behind a plane.
class Ground final : public Collider {
 public:
  Ground(const Eigen::Vector3d& normal, double offset, double friction)
      : normal_(normal.normalized()), offset_(offset), friction_(friction) {}

  void find(const Eigen::Matrix3Xd& x, const std::vector<double>& inverse_mass, double depth,
            Memory& /*memory*/, std::vector<ContactPlane>& planes,
            WorkCounters& /*work*/) const override {
    planes.clear();
    for (Eigen::Index v = 0; v < x.cols(); ++v) {
      if (inverse_mass[static_cast<std::size_t>(v)] > 0 && normal_.dot(x.col(v)) - offset_ < -depth)
        planes.push_back({static_cast<int>(v), normal_, offset_});
    }
  }
  bool plane_at(const Eigen::Vector3d& /*p*/, ContactPlane& plane,
                WorkCounters& /*work*/) const override {
    plane.normal = normal_;
    plane.offset = offset_;
    return true;
  }
  double friction() const override { return friction_; }
  int triangles() const override { return 0; }
  const Eigen::Vector3d& normal() const { return normal_; }
  double offset() const { return offset_; }

 private:
  Eigen::Vector3d normal_;
  double offset_, friction_;
};

// Points without edges, of mass 1, beside an obstacle.
inline Problem points(int n, std::shared_ptr<const Collider> collider, bool contact_inside = true) {
  ProblemParts parts;
  parts.contact_inside = contact_inside;
  parts.mass.assign(static_cast<std::size_t>(n), 1.0);
  parts.collider = std::move(collider);
  return Problem(std::move(parts));
}

// A collision filter's pass over points that were at `start`, as the paper's pipeline ends.
inline void push_out(std::shared_ptr<const Collider> collider, const Positions& start, Positions& x,
                     WorkCounters& work) {
  const Problem problem = points(static_cast<int>(x.cols()), std::move(collider), false);
  Contacts contacts(problem);
  contacts.begin(start, 0, 1);
  contacts.push_out(x, work);
}

}  // namespace inextensible::testing
