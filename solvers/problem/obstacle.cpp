#include "solvers/problem/obstacle.h"

namespace inextensible {

Obstacle::Obstacle(const Problem& problem) : problem_(problem), memory_(problem.vertices(), -1) {
  if (problem.body_motion()) seen_.resize(3, problem.vertices());
}

void Obstacle::place(double time) {
  if (const BodyMotion& motion = problem_.body_motion()) pose_ = motion(time);
}

void Obstacle::find(const Positions& x, double depth, std::vector<ContactPlane>& planes,
                    WorkCounters& work) {
  const Collider& collider = *problem_.collider();
  if (!problem_.body_motion()) {
    collider.find(x, problem_.inverse_mass(), depth, memory_, planes, work);
    return;
  }
  const Pose back = pose_.inverse();
  for (Eigen::Index i = 0; i < x.cols(); ++i) seen_.col(i) = back(x.col(i));
  collider.find(seen_, problem_.inverse_mass(), depth, memory_, planes, work);
  for (ContactPlane& plane : planes) place_plane(plane);
}

bool Obstacle::plane_at(const Eigen::Vector3d& p, ContactPlane& plane, WorkCounters& work) const {
  const Collider& collider = *problem_.collider();
  if (!problem_.body_motion()) return collider.plane_at(p, plane, work);
  if (!collider.plane_at(pose_.inverse()(p), plane, work)) return false;
  place_plane(plane);
  return true;
}

void Obstacle::place_plane(ContactPlane& plane) const {
  plane.normal = pose_.turn * plane.normal;
  plane.offset += plane.normal.dot(pose_.translation);
}

}  // namespace inextensible
