// The hard cases: small scenes in which solvers are known or expected to break, each with the
// outcome that theory or literature predicts for every solver.
#pragma once

#include <random>

#include "harness/scenes/meshes.h"
#include "harness/stability/trial.h"

namespace harness {

// The outcome that theory expects at the case's own, fixed step, and why. With smaller steps (after
// a refusal) solvers may survive, refuse or take too long, but nothing else.
struct Expectation {
  struct Other {
    Outcome outcome;
    std::string why;  // theory cannot decide: rounding, an iteration limit within the estimate, ...
  };
  std::vector<std::string> solvers;  // words of configs/hard_cases.json; none: all solvers
  Outcome outcome = Outcome::survived;
  std::string why;
  std::optional<Other> other = std::nullopt;

  bool about(const Backend& backend) const;
};

struct HardCase {
  std::string row;   // of the matrix, "Q1"; several cases may share one
  std::string name;  // unique, "Q1/0.01"
  std::string what;  // one line
  std::function<Trial()> build;
  double value = unknown;                      // of a series of cases
  std::vector<Expectation> expectations = {};  // the last one is about all methods

  // The first expectation about the solver. A method that promises no strain limit need not notice
  // that no solution satisfies it: where others refuse, it may survive.
  Expectation expectation(const std::string& solver) const;
};

std::vector<HardCase> hard_cases(const std::string& profile);
// The values that its series of cases run over, by the name of their list.
std::map<std::string, std::vector<double>> hard_case_values(const std::string& profile);
// Adds the expectations of configs/hard_cases.json that apply to each case.
void add_expectations(std::vector<HardCase>& cases);
// configs/hard_cases.json. Throws UsageError where it violates its schema.
const json& hard_cases_document();

// Outcomes of a solver that are known and are not what theory expects.
struct KnownDifference {
  std::string solver;
  Outcome fixed;                        // at the case's own step
  Outcome outcome;                      // with smaller steps, where that was refused
  std::string reason, remedy;           // what would make the outcome the expected one
  std::vector<std::string> hard_cases;  // their names
};

const std::vector<KnownDifference>& known_differences();
// Null for a difference that is not listed.
const KnownDifference* known_difference(const std::string& hard_case, const std::string& solver,
                                        const TrialResult& result);

}  // namespace harness

// ---- What hard cases are built from: small meshes, and trials of them ----

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
