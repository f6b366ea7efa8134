// An obstacle, as those of its half-spaces that vertices have come to (paper, section 4.4: nothing
// is to penetrate visibly).
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "solvers/problem/work_counters.h"

namespace inextensible {

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

  // What find() remembers of each vertex between calls, a row each: normal and offset of a plane
  // with the obstacle behind it. It makes calls cheaper, and changes no answer.
  using Memory = Eigen::MatrixX4d;
  static Memory nothing_of(int vertices) {  // planes with everything behind them
    Memory memory = Memory::Zero(vertices, 4);
    memory.col(3).setConstant(std::numeric_limits<double>::infinity());
    return memory;
  }

  // Replaces `planes` by one for every vertex of x (3 x n, m) that is deeper than `depth` inside
  // the obstacle, but for those of inverse mass 0: through the nearest point of the surface, across
  // the way there. By ascending vertex. `memory` has n rows.
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
