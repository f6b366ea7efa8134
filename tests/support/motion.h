// States in motion, and what of them is compared.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cstdint>

#include "support/random_mesh.h"

namespace inextensible::testing {

inline constexpr double h = 0.01;  // s, a time step

// Two vertices, an edge of length 1 between them, no gravity.
inline std::shared_ptr<const Problem> one_edge(double mass_a, double mass_b,
                                               std::vector<int> pinned = {}) {
  ProblemParts parts;
  parts.gravity.setZero();
  parts.mass = {mass_a, mass_b};
  parts.pinned = std::move(pinned);
  parts.edges = {{0, 1}};
  parts.rest_length = {1};
  return std::make_shared<const Problem>(std::move(parts));
}
// At rest along x, stretched or compressed to `length`.
inline State stretched_edge(double length) {
  State state{Positions::Zero(3, 2), Positions::Zero(3, 2), 0};
  state.x(0, 1) = length;
  return state;
}

// Velocities that would stretch edges by some per cent in one step at speed 4.
inline State moving_state(Random& random, const RandomMesh& mesh, double speed) {
  return {mesh.x, (perturbed(random, mesh, 1) - mesh.x) * speed, 0};
}

inline bool same_bits(const Positions& a, const Positions& b) {
  const auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
  return a.cols() == b.cols() && std::equal(a.data(), a.data() + a.size(), b.data(),
                                            [&](double p, double q) { return bits(p) == bits(q); });
}

inline Eigen::Vector3d linear_momentum(const Problem& p, const Positions& v) {
  return v * Eigen::Map<const Eigen::VectorXd>(p.mass().data(), p.vertices());
}

inline Eigen::Vector3d angular_momentum(const Problem& p, const Positions& x, const Positions& v) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    sum += p.mass()[i] * Eigen::Vector3d(x.col(i)).cross(Eigen::Vector3d(v.col(i)));
  return sum;
}

}  // namespace inextensible::testing
