// A chain that hangs from one pinned end, as links in place of vertices, for engines in joint
// (reduced) coordinates: one angle a link as long as the chain stays in the plane of x and y.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "contestants/common/engine.h"

namespace engines {

// Orientation and rotation of a link, whose own axes are x along it and, as long as the chain is
// in a plane, z across that.
struct LinkPose {
  Eigen::Quaterniond turn;  // from the axes of the link before it, the world's at the pin
  Eigen::Vector3d rate;     // rad/s, against that link, in its own axes: 0, y, z
};

// Link i ends at vertex[i], of mass[i], and begins at vertex[i - 1]; link 0 begins at the pin.
struct Links {
  // Throws std::invalid_argument, saying why, for a scene that is not such a chain.
  explicit Links(const InextensibleScene& scene);

  int count() const { return static_cast<int>(vertex.size()); }

  // Finds the pose of every link in a state, and refuses one in which a link has no direction.
  // Lengths are the chain's, not the state's, so velocities along a link are lost. A state that is
  // not planar makes the chain one in space, which it stays.
  void find_poses(const InextensibleStep& step);

  int pin = -1;
  std::vector<int> vertex;
  std::vector<double> length, mass;
  Eigen::Vector3d gravity;
  std::vector<LinkPose> poses;
  bool flat = false;  // positions, velocities and gravity have been in the plane of x and y
};

}  // namespace engines
