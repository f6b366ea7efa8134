// What hard cases are built from: small meshes, and trials of them.
#pragma once

#include <random>

#include "harness/scenes/meshes.h"
#include "harness/stability/trial.h"

namespace harness::cases {

constexpr double g = 9.81;  // m/s^2, the gravity of every mesh unless it is changed
inline const Eigen::Vector3d along(1, 0, 0), up(0, 1, 0), down(0, -1, 0);

// n vertices in one place, each of `mass` kg, without edges.
Draft points(int n, double mass);
// `links` links along `direction` (unit) from the origin, 1 m and 1 kg in all; `pinned` there.
Draft chain(int links, const Eigen::Vector3d& direction = along, bool pinned = true);
// n x n vertices, 1 m wide and 0.2 kg, horizontal, without shear; pinned at two corners of one
// edge. diagonals: one of each quad is constrained too.
Draft cloth(int n, bool diagonals = false);
Draft hung_cloth(int n);  // the same, pinned at one corner only
// The same triangles with vertices at the midpoints of their edges, each joined to the two others
// of its triangle at half the length of the opposite edge, and a third of the mass of its triangles
// (English and Bridson 2008). Pinned at the outermost midpoints of one edge of the cloth.
Draft midpoint_cloth(int n);

// `steps` steps of `step` seconds; 0: the scene's whole duration.
Trial trial_of(Scene scene, double step, int steps = 0, double strain_limit = 0.01);
Trial trial_of(Draft mesh, double step, int steps, double strain_limit = 0.01);

// Displaces every vertex that is not pinned by up to `size` m in each coordinate.
void add_noise(Positions& x, const std::vector<int>& pinned, double size, std::mt19937_64& random);

}  // namespace harness::cases
