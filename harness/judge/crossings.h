// Vertices that passed through the body within a step: in through a face, and out through one that
// looks the other way. Such a vertex was never seen inside, so no contact held it. A way that cuts
// a bulge or a corner of the body leaves through a face that looks a similar way, and is none.
#pragma once

#include "harness/scenes/scene.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {

class Crossings {
 public:
  // Without a body made of triangles it sees nothing, and costs nothing.
  explicit Crossings(const inextensible::Problem& problem);

  // Before and after each step.
  void before(const inextensible::State& state);
  void after(const inextensible::State& state);

  int vertices() const;  // that have passed through so far

 private:
  inextensible::Positions in_body_frame(const inextensible::State& state) const;
  bool passes_through(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  const inextensible::Problem& problem_;
  const inextensible::TriangleMesh* body_ = nullptr;
  double thickness_ = 0;  // m, about the least of the body
  inextensible::Positions from_;
  std::vector<char> crossed_;
};

}  // namespace harness
