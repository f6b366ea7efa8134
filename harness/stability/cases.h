// What hard cases are built from: small meshes, trials of them, and expectations.
#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "harness/stability/hard_case.h"
#include "harness/stability/trial.h"

namespace harness::cases {

constexpr double g = 9.81;  // m/s^2, the gravity of every mesh unless it is changed
inline const Eigen::Vector3d along(1, 0, 0), up(0, 1, 0), down(0, -1, 0);

struct Mesh {
  inextensible::ProblemParts parts;
  inextensible::State start;
};

// n vertices in one place, each of `mass` kg, without edges.
Mesh points(int n, double mass);
void join(Mesh& mesh, int a, int b, double rest_length);  // by an edge, m
// `links` links on a line from the origin along `direction` (unit), 1 m and 1 kg in all; `pinned`
// at the origin.
Mesh chain(int links, const Eigen::Vector3d& direction = along, bool pinned = true);
// n x n vertices, 1 m wide and 0.2 kg, horizontal, without shear; pinned at two corners of one
// edge. diagonals: one of each quad is constrained too.
Mesh cloth(int n, bool diagonals = false);
Mesh hung_cloth(int n);  // the same, pinned at one corner only
// The same triangles with vertices at the midpoints of their edges, each joined to the two others
// of its triangle at half the length of the opposite edge, and a third of the mass of its triangles
// (English and Bridson 2008). Pinned at the outermost midpoints of one edge of the cloth.
Mesh midpoint_cloth(int n);

// A scene of scene_types() with some parameters given.
Scene scene_of(const char* name, const SceneParameters& given);

// `steps` steps of `step` seconds; 0: the scene's whole duration.
Trial trial_of(Scene scene, double step, int steps = 0, double strain_limit = 0.01);
Trial trial_of(Mesh mesh, double step, int steps, double strain_limit = 0.01);

// The closest point of the manifold is at most twice as far from the start as the candidate is, so
// that a velocity filter may return up to four times the candidate's kinetic energy: an
// energy_tolerance.
constexpr double closest_point_energy = 3;

// Displaces every vertex that is not pinned by up to `size` m in each coordinate.
void add_noise(inextensible::Positions& x, const std::vector<int>& pinned, double size,
               std::mt19937_64& random);

// Solvers, by where they take the constraint direction.
constexpr auto current_direction = inextensible::Direction::current;
constexpr auto end_direction = inextensible::Direction::end;
constexpr auto start_direction = inextensible::Direction::start;
constexpr auto strain_limiting = inextensible::Direction::local;
constexpr auto springs = inextensible::Direction::springs;
inline const Solvers everyone;
// Methods of multipliers: the direction of the end, but each edge's multiplier grows by itself, by
// `multiplier_penalty` times its elongation over its ends' inertia in a pass. No matrix of J is
// solved.
inline const Solvers multipliers{"augmented_vbd", "admm"};
constexpr double multiplier_penalty = 10;

constexpr Outcome survives = Outcome::survived, refuses = Outcome::refused;

// Cases are added to this, family by family.
struct Cases {
  const HardCaseValues& values;
  std::vector<HardCase> list = {};

  void add(std::string row, std::string name, std::string what, std::function<Trial()> build,
           std::vector<Expectation> expectations) {
    list.push_back({std::move(row), std::move(name), std::move(what), std::move(build),
                    std::move(expectations)});
  }
};
inline Expectation survive(Solvers who, std::string why) {
  return {std::move(who), survives, std::move(why)};
}
inline Expectation refuse(Solvers who, std::string why) {
  return {std::move(who), refuses, std::move(why)};
}

void add_failure_configurations(Cases& cases);
void add_taut(Cases& cases);
void add_degenerate(Cases& cases);
void add_mass_ratios(Cases& cases);
void add_whip(Cases& cases);
void add_large(Cases& cases);
void add_contact(Cases& cases);
void add_far_starts(Cases& cases);
void add_impossible_numbers(Cases& cases);

}  // namespace harness::cases
