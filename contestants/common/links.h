// A chain that hangs from one pinned end, as links in place of vertices: what engines in joint
// coordinates (reduced coordinates) are made from and set from. No header of the library, for
// engines whose headers are older than C++20.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace inextensible {
class Problem;
struct State;
}  // namespace inextensible

namespace engines {

// Link i leads to vertex[i], which bears mass[i], from vertex[i - 1]; the first from the pin.
struct Links {
  // Throws std::invalid_argument, saying why, for a problem that is no such chain.
  explicit Links(const inextensible::Problem& problem);

  int count() const { return static_cast<int>(vertex.size()); }

  int pin = -1;
  std::vector<int> vertex;
  std::vector<double> length, mass;
};

// How a link lies and turns.
struct LinkPose {
  Eigen::Matrix3d axes;  // the link's own, as columns: the first along it, the third z in a plane
  Eigen::Vector3d rate;  // rad/s; no link spins about itself against the one before it
};

using LinkPoses = std::vector<LinkPose>;

// Whether the chain lies, moves and weighs in the plane of x and y: one angle a link is enough.
bool planar(const Links& links, const inextensible::Problem& problem,
            const inextensible::State& state);

// How the links lie and turn in a state; `poses` has one for each. Lengths are the chain's,
// whatever the state's: what of a velocity is along its link is lost. False if a link has no
// direction.
bool find_poses(const Links& links, const inextensible::State& state, bool planar,
                LinkPoses& poses);

}  // namespace engines
