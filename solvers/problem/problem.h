// The problem of every backend: point masses joined by edges that must keep their rest length.
//
// Notation of Goldenthal et al. 2007 throughout: x, v are 3 x n (one column a vertex; m and m/s), W
// = M^-1 is the diagonal inverse mass matrix (1/kg; 0 = pinned), l_k is the rest length of
// warp/weft edge k = (a, b) in metres. Gravity is always there; shear, bending, drag and a
// collider are optional parts, and a part that is absent costs nothing.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "solvers/problem/bending.h"
#include "solvers/problem/collider.h"

namespace inextensible {

using Positions = Eigen::Matrix3Xd;  // one column a vertex, contiguous x y z

struct Edge {
  int a, b;
};

// Linear springs, energy k/2 (|x_b - x_a| - r)^2. Shear: both diagonals of each quad (paper,
// section 3). A problem has them, and its bending stencils, in an order of its own, in which those
// of consecutive vertices follow each other.
struct Springs {
  std::vector<Edge> edges;
  std::vector<double> rest_length;  // m
  std::vector<double> stiffness;    // N/m
};

// What a problem is made from; see Problem for the conditions.
struct ProblemParts {
  std::vector<double> mass;         // kg, one a vertex
  std::vector<int> pinned;          // vertices that no force moves
  std::vector<Edge> edges;          // constrained (warp and weft) edges
  std::vector<double> rest_length;  // m, one a constrained edge
  // The strain limit of each constrained edge over that of the tightest, at least 1: that of warp
  // and weft may differ. Empty: all are 1. A method may keep the tightest everywhere.
  std::vector<double> limit_scale;
  Eigen::Vector3d gravity{0, -9.81, 0};  // m/s^2
  std::optional<Springs> shear;
  Bending bending;           // empty: none
  std::vector<double> drag;  // N s/m, one a vertex, of air at rest: force -drag v; empty: none
  // Shear, bending and drag act with their forces at the end of a step instead of its start where
  // the step is too long for that (systems/implicit_forces.h).
  bool implicit_forces = false;
  std::shared_ptr<const Collider> collider;  // null: nothing to collide with
  BodyMotion body_motion;                    // of the collider; empty: it stays
  bool pins_follow_body = false;             // pinned vertices move as if fixed to the body
  // Methods keep vertices out of the obstacle while they keep edges to their lengths. false: a step
  // ends with a pass that moves vertices out, after which edges are not looked at again (the
  // paper's pipeline, section 4.4).
  bool contact_inside = true;
};

// Immutable. The constructor throws std::invalid_argument, naming the vertex or edge, unless masses
// and lengths are positive and finite, edges join two different existing vertices that are not both
// pinned, and all arrays fit.
class Problem {
 public:
  explicit Problem(ProblemParts parts);

  int vertices() const { return static_cast<int>(parts_.mass.size()); }
  int constraints() const { return static_cast<int>(parts_.edges.size()); }
  const std::vector<double>& mass() const { return parts_.mass; }
  const std::vector<double>& inverse_mass() const { return inverse_mass_; }
  const std::vector<int>& pinned() const { return parts_.pinned; }
  const std::vector<Edge>& edges() const { return parts_.edges; }
  const std::vector<double>& rest_length() const { return parts_.rest_length; }
  const std::vector<double>& limit_scale() const { return parts_.limit_scale; }
  double shortest_rest_length() const { return shortest_rest_length_; }
  double longest_rest_length() const { return longest_rest_length_; }  // 0 without edges
  double total_mass() const { return total_mass_; }
  const Eigen::Vector3d& gravity() const { return parts_.gravity; }
  const Springs* shear() const { return parts_.shear ? &*parts_.shear : nullptr; }
  const Bending& bending() const { return parts_.bending; }
  // Springs of shear, and bending stencils, come in runs: the vertices of each are those of the one
  // before, plus 1, and stencils of a run have the same coefficients and stiffness. Run lengths.
  const std::vector<std::size_t>& shear_runs() const { return shear_runs_; }
  const std::vector<std::size_t>& bending_runs() const { return bending_runs_; }
  bool has_drag() const { return !parts_.drag.empty(); }
  double drag(int vertex) const { return has_drag() ? parts_.drag[vertex] : 0; }
  // Whether there are forces that long steps take implicitly.
  bool implicit_forces() const {
    return parts_.implicit_forces && (parts_.shear || !parts_.bending.empty() || has_drag());
  }
  const Collider* collider() const { return parts_.collider.get(); }
  const BodyMotion& body_motion() const { return parts_.body_motion; }
  bool pins_follow_body() const { return parts_.pins_follow_body; }
  // Whether there is a collider that methods take into account.
  bool contact_inside() const { return parts_.collider && parts_.contact_inside; }

 private:
  ProblemParts parts_;
  std::vector<double> inverse_mass_;
  std::vector<std::size_t> shear_runs_, bending_runs_;
  double shortest_rest_length_ = 0, longest_rest_length_ = 0, total_mass_ = 0;
};

struct State {
  Positions x;      // m
  Positions v;      // m/s
  double time = 0;  // s
};

// Throws std::invalid_argument, naming the vertex, if shapes differ from the problem's or a number
// is not finite.
void check_state(const Problem& problem, const State& state);

}  // namespace inextensible
