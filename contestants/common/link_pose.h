// How a link lies and turns; no header of the library, for engines whose headers are older than
// C++20.
#pragma once

#include <Eigen/Core>

namespace engines {

struct LinkPose {
  Eigen::Matrix3d axes;  // the link's own, as columns: the first along it, the third z in a plane
  Eigen::Vector3d rate;  // rad/s; no link spins about itself against the one before it
};

}  // namespace engines
