// A chain that hangs from one pinned end, as links in place of vertices, for engines in joint
// (reduced) coordinates. Includes no header of the library, because some engines' headers are not
// C++20.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace inextensible {
class Problem;
struct State;
}  // namespace inextensible

namespace engines {

// Link i ends at vertex[i], of mass[i], and begins at vertex[i - 1]; link 0 begins at the pin.
struct Links {
  // Throws std::invalid_argument, saying why, for a problem that is not such a chain.
  explicit Links(const inextensible::Problem& problem);

  int count() const { return static_cast<int>(vertex.size()); }

  int pin = -1;
  std::vector<int> vertex;
  std::vector<double> length, mass;
};

// Orientation and rotation of a link.
struct LinkPose {
  Eigen::Matrix3d axes;  // the link's own, as columns: the first along it, the third z in a plane
  Eigen::Vector3d rate;  // rad/s, against the link before it, without spin about itself
};

using LinkPoses = std::vector<LinkPose>;

// Whether positions, velocities and gravity are in the plane of x and y: one angle a link suffices.
bool planar(const Links& links, const inextensible::Problem& problem,
            const inextensible::State& state);

// Finds the pose of every link in a state. Lengths are the chain's, not the state's, so velocities
// along a link are lost. False if a link has no direction.
bool find_poses(const Links& links, const inextensible::State& state, bool planar,
                LinkPoses& poses);

}  // namespace engines
