// A problem's collider where its motion has brought it.
#pragma once

#include "solvers/problem/problem.h"

namespace inextensible {

class Obstacle {
 public:
  // The problem has a collider, and outlives this.
  explicit Obstacle(const Problem& problem)
      : problem_(problem), memory_(problem.collider()->nothing_of(problem.vertices())) {
    if (problem.body_motion()) seen_.resize(3, problem.vertices());
  }

  // Moves it to where it is at `time`, s. Comes first for one that moves.
  void place(double time) {
    if (const BodyMotion& motion = problem_.body_motion()) pose_ = motion(time);
  }
  const Pose& pose() const { return pose_; }

  // As Collider::find, of all vertices but the pinned ones.
  void find(const Positions& x, double depth, std::vector<ContactPlane>& planes,
            WorkCounters& work) {
    const bool moves = static_cast<bool>(problem_.body_motion());
    if (moves) {
      const Pose back = pose_.inverse();
      for (Eigen::Index i = 0; i < x.cols(); ++i) seen_.col(i) = back(x.col(i));
    }
    problem_.collider()->find(moves ? seen_ : x, problem_.inverse_mass(), depth, memory_, planes,
                              work);
    for (ContactPlane& plane : planes) place_plane(plane);
  }
  // As Collider::plane_at.
  bool plane_at(const Eigen::Vector3d& p, ContactPlane& plane, WorkCounters& work) const {
    const bool moves = static_cast<bool>(problem_.body_motion());
    if (!problem_.collider()->plane_at(moves ? pose_.inverse()(p) : p, plane, work)) return false;
    place_plane(plane);
    return true;
  }

 private:
  void place_plane(ContactPlane& plane) const {  // from the body's frame
    if (!problem_.body_motion()) return;
    plane.normal = pose_.turn * plane.normal;
    plane.offset += plane.normal.dot(pose_.translation);
  }

  const Problem& problem_;
  Collider::Memory memory_;
  // For a body that moves.
  Pose pose_;
  Positions seen_;  // x as the body sees it
};

}  // namespace inextensible
