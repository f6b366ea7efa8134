// The collision filter: the last pass of a step, so that nothing penetrates visibly (paper,
// section 4.4).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "inextensible/problem/work_counters.h"

namespace inextensible {

class Collider {
 public:
  Collider() = default;
  Collider(const Collider&) = delete;
  Collider& operator=(const Collider&) = delete;
  virtual ~Collider() = default;

  // Moves every free vertex of x (3 x n, m) that is inside the obstacle back to its surface, and
  // takes Coulomb friction off its displacement since x_start. Vertices of inverse mass 0 are not
  // touched.
  virtual void resolve(const Eigen::Matrix3Xd& x_start, const std::vector<double>& inverse_mass,
                       Eigen::Matrix3Xd& x, WorkCounters& work) const = 0;

  virtual int triangles() const = 0;
};

}  // namespace inextensible
