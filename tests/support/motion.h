// Small problems and their states, at rest or in motion; an obstacle and what stands on it.
#pragma once

#include "solvers/problem/contacts.h"
#include "support/random_mesh.h"

namespace inextensible::testing {

inline constexpr double h = 0.01;  // s, a time step
// Of displacements of some metres, m, as passes in single precision leave them.
inline constexpr double single_rounding = 1e-6;

// An edge at rest along x, stretched or compressed to `length`.
inline State stretched_edge(double length) {
  State state{Positions::Zero(3, 2), Positions::Zero(3, 2), 0};
  state.x(0, 1) = length;
  return state;
}
// The problem of such an edge, whose rest length is 1 m.
inline std::shared_ptr<const Problem> one_edge(double mass_a, double mass_b,
                                               std::vector<int> pinned = {}) {
  return std::make_shared<const Problem>(
      parts_at_rest(stretched_edge(1).x, {{0, 1}}, {mass_a, mass_b}, std::move(pinned)));
}

// Velocities that would stretch edges by some per cent in one step at speed 4.
inline State moving_state(Random& random, const RandomMesh& mesh, double speed) {
  return {mesh.x, (perturbed(random, mesh, 1) - mesh.x) * speed, 0};
}

// A rope that hangs by one end, vertex 0, at rest.
struct HangingRope {
  static constexpr double gravity = 9.81;
  // Links of this length (m), vertices of this mass (kg).
  HangingRope(int links, double length, double mass) {
    ProblemParts parts;
    parts.gravity = {0, -gravity, 0};
    parts.mass.assign(links + 1, mass);
    parts.pinned = {0};
    parts.rest_length.assign(links, length);
    start = {Positions::Zero(3, links + 1), Positions::Zero(3, links + 1), 0};
    for (int i = 0; i < links; ++i) {
      parts.edges.push_back({i, i + 1});
      start.x(1, i + 1) = -length * (i + 1);
    }
    problem = std::make_shared<const Problem>(parts);
  }
  std::shared_ptr<const Problem> problem;
  State start;
};

// All that lies behind a plane.
struct Ground final : Collider {
  Ground(const Eigen::Vector3d& along, double at, double friction)
      : normal(along.normalized()), offset(at), friction_(friction) {}

  void find(const Eigen::Matrix3Xd& x, const std::vector<double>& inverse_mass, double depth,
            Memory& /*memory*/, std::vector<ContactPlane>& planes,
            WorkCounters& /*work*/) const override {
    planes.clear();
    for (Eigen::Index v = 0; v < x.cols(); ++v)
      if (inverse_mass[static_cast<std::size_t>(v)] > 0 && normal.dot(x.col(v)) - offset < -depth)
        planes.push_back({static_cast<int>(v), normal, offset});
  }
  bool plane_at(const Eigen::Vector3d& /*p*/, ContactPlane& plane,
                WorkCounters& /*work*/) const override {
    plane.normal = normal;
    plane.offset = offset;
    return true;
  }
  double friction() const override { return friction_; }
  int triangles() const override { return 0; }

  Eigen::Vector3d normal;
  double offset, friction_;
};

// Points without edges, of mass 1, beside an obstacle.
inline Problem points(int n, std::shared_ptr<const Collider> collider, bool contact_inside = true) {
  ProblemParts parts;
  parts.contact_inside = contact_inside;
  parts.mass.assign(static_cast<std::size_t>(n), 1.0);
  parts.collider = std::move(collider);
  return Problem(std::move(parts));
}

}  // namespace inextensible::testing
