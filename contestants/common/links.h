// A chain that hangs from one pinned end, as links in place of vertices, for engines in joint
// (reduced) coordinates: one angle a link as long as the chain stays in the plane of x and y.
#pragma once

#include <vector>

#include "contestants/common/engine.h"

namespace engines {

// Orientation and rotation of a link.
struct LinkPose {
  Eigen::Matrix3d axes;  // the link's own, as columns: the first along it, the third z in a plane
  Eigen::Vector3d rate;  // rad/s, against the link before it, without spin about itself
};

// Link i ends at vertex[i], of mass[i], and begins at vertex[i - 1]; link 0 begins at the pin.
class Links {
 public:
  // Throws std::invalid_argument, saying why, for a scene that is not such a chain.
  explicit Links(const InextensibleScene& scene);

  int count() const { return static_cast<int>(vertex.size()); }

  // Finds the pose of every link in a state. Lengths are the chain's, not the state's, so
  // velocities along a link are lost. A state that is not planar makes the chain one in space,
  // which it stays. False if a link has no direction.
  bool find_poses(const double* x, const double* v);

  int pin = -1;
  std::vector<int> vertex;
  std::vector<double> length, mass;
  Eigen::Vector3d gravity;
  std::vector<LinkPose> poses;
  bool flat = false;  // positions, velocities and gravity have been in the plane of x and y

 private:
  bool planar(const double* x, const double* v) const;
};

}  // namespace engines
