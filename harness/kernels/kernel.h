// What the kernels are timed on, and how one is registered.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "harness/scenes/scene.h"
#include "solvers/systems/constraint_system.h"

namespace harness::kernels {

// A scene after some steps of fast projection: deformed, in contact where there is something to
// touch.
struct Moment {
  Scene scene;
  double h;  // s
  inextensible::State state;
  inextensible::Positions x0;  // after the next unconstrained step
  const inextensible::Problem& problem() const { return *scene.problem; }
};

// Made once: Google Benchmark calls each benchmark several times to find its number of iterations.
const Moment& moment(const std::string& scene, int n);

// J W J^T at x0 in the solver's order, not yet factored.
struct Linearized {
  Linearized(const Moment& m, std::string_view name);
  inextensible::ConstraintSystem system;
  Eigen::Matrix3Xd u;
  Eigen::VectorXd c;
  std::unique_ptr<inextensible::SpdSolver> solver;
};

using Body = std::function<void(benchmark::State&)>;
benchmark::internal::Benchmark* add(const std::string& name, const Body& body);

// Items are constrained edges, or vertices.
void per_item(benchmark::State& state, int items, const char* what = "s_per_edge");

// Seconds for a square root and a division, the least of many: what no pass that corrects every
// edge can go below.
double sqrt_div_seconds();

// Each of one file. `at`: where, "/chain:80".
void register_floors();
void register_steps(const std::string& scene, int n, const std::string& at);
void register_collision(const std::string& scene, int n, const std::string& at);
void register_iterations(const std::string& scene, int n, const std::string& at,
                         const std::vector<std::string>& solvers);
void register_strain_passes(int n, const std::string& at);  // of the drape
void register_schur_complement(const std::string& scene, int n, const std::string& at,
                               const std::vector<std::string>& solvers);
void register_whole_systems(int n, const std::vector<std::string>& solvers);  // of the drape
void register_saddle_point(int n, const std::string& at,
                           const std::vector<std::string>& solvers);  // of the drape

}  // namespace harness::kernels
