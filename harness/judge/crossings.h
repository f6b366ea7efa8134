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
  explicit Crossings(const Problem& problem);

  // Before and after each step.
  void before(const State& state);
  void after(const State& state);

  int vertices() const;  // that have passed through so far

 private:
  Positions in_body_frame(const State& state) const;
  bool passes_through(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  const Problem& problem_;
  const inextensible::TriangleMesh* body_ = nullptr;
  double thickness_ = 0;  // m, about the least of the body
  Positions from_;
  std::vector<char> crossed_;
};

}  // namespace harness
