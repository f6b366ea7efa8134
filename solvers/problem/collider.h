// An obstacle, as those of its half-spaces that vertices have come to (paper, section 4.4: nothing
// is to penetrate visibly), and how it moves.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "solvers/problem/work_counters.h"

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

// What keeps a vertex out of an obstacle: normal . x >= offset.
struct ContactPlane {
  int vertex;
  Eigen::Vector3d normal;  // unit, out of the obstacle
  double offset;           // m
};

class Collider {
 public:
  Collider() = default;
  Collider(const Collider&) = delete;
  Collider& operator=(const Collider&) = delete;
  virtual ~Collider() = default;

  // What find() remembers of each vertex between calls, a row each for every piece of the
  // obstacle: normal and offset of a plane with the piece behind it. It makes calls cheaper, and
  // changes no answer.
  using Memory = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;
  virtual Memory nothing_of(int vertices) const {  // planes with everything behind them
    Memory memory = Memory::Zero(vertices, 4);
    memory.col(3).setConstant(std::numeric_limits<double>::infinity());
    return memory;
  }

  // Replaces `planes` by one for every vertex of x (3 x n, m) that is deeper than `depth` inside
  // the obstacle, but for those of inverse mass 0: through the nearest point of the surface, across
  // the way there. By ascending vertex. `memory` comes from nothing_of(n).
  virtual void find(const Eigen::Matrix3Xd& x, const std::vector<double>& inverse_mass,
                    double depth, Memory& memory, std::vector<ContactPlane>& planes,
                    WorkCounters& work) const = 0;

  // The plane through the point of the surface that is nearest to p, inside or outside, across the
  // way there; of a convex obstacle, another that p is in front of will do. False, and no plane,
  // where the surface is not near. The vertex is left as it is.
  virtual bool plane_at(const Eigen::Vector3d& p, ContactPlane& plane,
                        WorkCounters& work) const = 0;

  virtual double friction() const = 0;  // Coulomb coefficient
  virtual int triangles() const = 0;
};

}  // namespace inextensible
