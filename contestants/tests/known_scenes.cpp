#include "contestants/tests/known_scenes.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>

#include "solvers/plugin.h"
#include "solvers/problem/edge_constraints.h"
#include "solvers/problem/forces.h"
#include "support/motion.h"

namespace engines {

using inextensible::Positions;
using inextensible::ProblemParts;
using inextensible::Settings;
using inextensible::State;

namespace {

// A plug-in's rows, in the registry; once.
void load(const std::string& plugin) {
  static std::set<std::string> loaded;
  if (!loaded.insert(plugin).second) return;
  void* library = dlopen((PLUGIN_FOLDER "/" + plugin + ".so").c_str(), RTLD_NOW | RTLD_LOCAL);
  ASSERT_TRUE(library) << dlerror();
  const auto entry =
      reinterpret_cast<decltype(&inextensible_plugin)>(dlsym(library, "inextensible_plugin"));
  ASSERT_TRUE(entry);
  inextensible::add_backends({entry()->backends, entry()->backend_count});
}

ProblemParts chain_parts(int links) {
  ProblemParts parts;
  parts.mass.assign(links + 1, 1.0 / links);
  parts.pinned = {0};
  for (int i = 0; i < links; ++i) parts.edges.push_back({i, i + 1});
  parts.rest_length.assign(links, 1.0 / links);
  return parts;
}

Scene finished(ProblemParts parts, Positions x, Positions v) {
  return {std::make_shared<const inextensible::Problem>(std::move(parts)),
          {std::move(x), std::move(v)}};
}

}  // namespace

Scene chain(int links, double turn) {
  Positions x(3, links + 1);
  for (int i = 0; i <= links; ++i)
    x.col(i) << std::cos(turn) * i / links, 0, -std::sin(turn) * i / links;
  return finished(chain_parts(links), x, Positions::Zero(3, links + 1));
}

Scene hanging_chain(int links) {
  Scene scene = chain(links);
  scene.start.x.row(1) = -scene.start.x.row(0);
  scene.start.x.row(0).setZero();
  return scene;
}

Scene swirling_chain(int links) {
  Positions x = Positions::Zero(3, links + 1), v = x;
  for (int i = 0; i < links; ++i) {
    // Directions all over the sphere, one of them straight along z, and rates across them.
    const double polar = i == 1 ? 0 : 2.3 * std::sin(1.7 * i), azimuth = 2.1 * i;
    const Eigen::Vector3d e(std::sin(polar) * std::cos(azimuth),
                            std::sin(polar) * std::sin(azimuth), std::cos(polar));
    const Eigen::Vector3d rate(std::cos(i), std::sin(2.0 * i), std::cos(3.0 * i));
    x.col(i + 1) = x.col(i) + e / links;
    v.col(i + 1) = v.col(i) + rate.cross(e) / links;
  }
  return finished(chain_parts(links), x, v);
}

Scene spinning_net(int n, double omega) {
  ProblemParts parts;
  parts.mass.assign(n * n, 1.0 / (n * n));
  parts.gravity.setZero();
  const double length = 1.0 / (n - 1);
  Positions x(3, n * n), v(3, n * n);
  for (int i = 0; i < n * n; ++i) {
    const int row = i / n, column = i % n;
    x.col(i) << column * length - 0.5, 0, row * length - 0.5;
    v.col(i) = omega * Eigen::Vector3d::UnitY().cross(Eigen::Vector3d(x.col(i)));
    if (column + 1 < n) parts.edges.push_back({i, i + 1});
    if (row + 1 < n) parts.edges.push_back({i, i + n});
  }
  parts.rest_length.assign(parts.edges.size(), length);
  return finished(parts, x, v);
}

std::unique_ptr<inextensible::Stepper> make(const std::string& solver, const Scene& scene,
                                            const Settings& settings) {
  load(solver);
  inextensible::BackendOptions options{0.01, 1, settings};
  options.start = &scene.start;
  return inextensible::make_stepper(solver, scene.problem, options);
}

State run(const std::string& solver, const Scene& scene, double h, int steps,
          const Settings& settings) {
  const auto stepper = make(solver, scene, settings);
  State state = scene.start;
  for (int i = 0; i < steps; ++i) {
    const auto result = stepper->advance(state, h);
    EXPECT_TRUE(result) << "step " << i << ": " << result.detail;
    if (!result) break;
  }
  return state;
}

double energy(const Scene& scene, const State& state) {
  return kinetic_energy(*scene.problem, state.v) + potential_energy(*scene.problem, state.x);
}

Eigen::Vector3d angular_momentum(const Scene& scene, const State& state) {
  return inextensible::testing::angular_momentum(*scene.problem, state.x, state.v);
}

double largest_strain(const Scene& scene, const State& state) {
  return std::abs(inextensible::EdgeConstraints(*scene.problem, 1).worst(state.x).strain);
}

double distance(const Positions& a, const Positions& b) {
  return (a - b).colwise().norm().maxCoeff();
}

double pendulum_error(const std::string& solver, int steps, const Settings& settings) {
  const Scene scene = chain(1);
  // A quarter of the period 4 sqrt(l / g) K(sin(90 degrees / 2)), with l = 1.
  const double quarter = std::comp_ellint_1(std::sqrt(0.5)) / std::sqrt(9.81);
  const State end = run(solver, scene, quarter / steps, steps, settings);
  return (end.x.col(1) + Eigen::Vector3d::UnitY()).norm();
}

void expect_refusal_without_trace(const std::string& solver, const Scene& scene,
                                  const State& impossible, double h) {
  const auto stepper = make(solver, scene), fresh = make(solver, scene);
  State state = impossible;
  EXPECT_FALSE(stepper->advance(state, h));
  EXPECT_TRUE(state.x == impossible.x && state.v == impossible.v && state.time == impossible.time);
  State after = scene.start, expected = scene.start;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(stepper->advance(after, 1e-3));
    ASSERT_TRUE(fresh->advance(expected, 1e-3));
  }
  EXPECT_TRUE(after.x == expected.x && after.v == expected.v);
}

void expect_first_order(const std::string& solver) {
  const double coarse = pendulum_error(solver, 1000), fine = pendulum_error(solver, 2000);
  EXPECT_LT(fine, 0.01);
  EXPECT_NEAR(std::log2(coarse / fine), 1, 0.1);
}

void expect_free_flight(const std::string& solver) {
  Scene scene = spinning_net(4, 0);
  scene.start.v.colwise() = Eigen::Vector3d(3, -2, 1);
  constexpr double h = 1.0 / 128;  // that single precision holds
  const State after = run(solver, scene, h, 1);
  EXPECT_LT(distance(after.x, scene.start.x + h * scene.start.v), 1e-14);
  EXPECT_LT(distance(after.v, scene.start.v), 1e-12);
  EXPECT_LT(distance(run(solver, scene, h, 1000).v, scene.start.v), 1e-10);
}

void expect_spring(const std::string& solver) {
  ProblemParts parts;
  parts.mass = {1, 1};
  parts.gravity.setZero();
  parts.shear = inextensible::Springs{{{0, 1}}, {1}, {50}};
  Positions x = Positions::Zero(3, 2);
  x.row(0) << -0.55, 0.55;
  const Scene scene = finished(parts, x, Positions::Zero(3, 2));
  const State after = run(solver, scene, std::numbers::pi / 10 / 3200, 3200);  // half a period
  EXPECT_NEAR(after.x(0, 1), 0.45, 1e-4);
  EXPECT_NEAR(after.x(0, 0), -0.45, 1e-4);
}

void expect_unsupported(const std::string& solver, const Scene& scene, const std::string& why) {
  try {
    make(solver, scene);
    FAIL() << solver << " takes it";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
}

}  // namespace engines
