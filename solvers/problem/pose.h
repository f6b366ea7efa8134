// Where a rigid body is, and how it moves.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace inextensible {

// Takes the body's own points to where they are: p -> turn p + translation.
struct Pose {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();     // a rotation
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // m

  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const { return turn * p + translation; }
  Pose inverse() const { return {turn.transpose(), -(turn.transpose() * translation)}; }
  // First the other, then this.
  Pose operator*(const Pose& other) const {
    return {turn * other.turn, turn * other.translation + translation};
  }
};

// Pose at a time, s. Does not depend on earlier calls.
using BodyMotion = std::function<Pose(double time)>;

}  // namespace inextensible
