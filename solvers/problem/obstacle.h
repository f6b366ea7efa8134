// A problem's collider, there where its motion has brought it.
#pragma once

#include "solvers/problem/problem.h"

namespace inextensible {

class Obstacle {
 public:
  // The problem has a collider, and outlives this.
  explicit Obstacle(const Problem& problem);

  // From now on it is where it is at `time`, s. Of one that moves, before anything else.
  void place(double time);
  const Pose& pose() const { return pose_; }

  // As Collider::find, of all vertices but the pinned ones.
  void find(const Positions& x, double depth, std::vector<ContactPlane>& planes,
            WorkCounters& work);
  // As Collider::plane_at.
  bool plane_at(const Eigen::Vector3d& p, ContactPlane& plane, WorkCounters& work) const;

 private:
  void place_plane(ContactPlane& plane) const;  // from the body's frame

  const Problem& problem_;
  Collider::Memory memory_;
  // For a body that moves.
  Pose pose_;
  Positions seen_;  // x as the body sees it
};

}  // namespace inextensible
