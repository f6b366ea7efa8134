// Scenes whose motion, or part of it, theory knows, and what the engines' tests share.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "solvers/c_method.h"
#include "solvers/problem/edge_constraints.h"
#include "solvers/problem/forces.h"
#include "solvers/registry.h"
#include "support/motion.h"

namespace engines {

using inextensible::Positions;
using inextensible::ProblemParts;
using inextensible::Settings;
using inextensible::State;
using inextensible::testing::parts_at_rest;

struct Scene {
  std::shared_ptr<const inextensible::Problem> problem;
  State start;
};

// Adds a plug-in's rows to the registry, once.
inline void load(const std::string& plugin) {
  if (inextensible::find_backend(plugin)) return;
  void* library = dlopen((PLUGIN_FOLDER "/" + plugin + ".so").c_str(), RTLD_NOW | RTLD_LOCAL);
  ASSERT_TRUE(library) << dlerror();
  const auto entry =
      reinterpret_cast<decltype(&inextensible_plugin)>(dlsym(library, "inextensible_plugin"));
  ASSERT_TRUE(entry);
  const std::vector rows{inextensible::row_of(entry()->methods[0])};
  inextensible::add_backends(rows);
}

inline Scene finished(ProblemParts parts, Positions x, Positions v) {
  return {std::make_shared<const inextensible::Problem>(std::move(parts)),
          {std::move(x), std::move(v)}};
}

// `links` equal links of 1 m and 1 kg in all, pinned at the origin, at rest, straight down.
inline Scene hanging_chain(int links) {
  const inextensible::testing::HangingRope rope(links, 1.0 / links, 1.0 / links);
  return {rope.problem, rope.start};
}

// The same, along x, turned about y by `turn`.
inline Scene chain(int links, double turn = 0) {
  Positions x(3, links + 1);
  for (int i = 0; i <= links; ++i)
    x.col(i) << std::cos(turn) * i / links, 0, -std::sin(turn) * i / links;
  return {hanging_chain(links).problem, {x, Positions::Zero(3, links + 1)}};
}

// The same, bent and moving in all directions, every link at its length.
inline Scene swirling_chain(int links) {
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
  return {hanging_chain(links).problem, {x, v}};
}

// A stepper of the plug-in with this name.
inline std::unique_ptr<inextensible::Stepper> make(const std::string& solver, const Scene& scene,
                                                   const Settings& settings = {}) {
  load(solver);
  return inextensible::make_stepper(solver, scene.problem, {0.01, 1, settings, &scene.start});
}

// The state after that many steps, none of which may be refused.
inline State run(const std::string& solver, const Scene& scene, double h, int steps,
                 const Settings& settings = {}) {
  const auto stepper = make(solver, scene, settings);
  State state = scene.start;
  for (int i = 0; i < steps; ++i) {
    const auto result = stepper->advance(state, h);
    EXPECT_TRUE(result) << "step " << i << ": " << result.detail;
    if (!result) break;
  }
  return state;
}

// About the origin.
inline Eigen::Vector3d angular_momentum(const Scene& scene, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < scene.problem->vertices(); ++i)
    sum += scene.problem->mass()[i] * state.x.col(i).head<3>().cross(state.v.col(i).head<3>());
  return sum;
}

inline double largest_strain(const Scene& scene, const State& state) {
  return std::abs(inextensible::EdgeConstraints(*scene.problem, 1).worst(state.x).strain);
}

inline double distance(const Positions& a, const Positions& b) {
  return (a - b).colwise().norm().maxCoeff();
}

// ---- What every engine must pass ----

// A link that is released level hangs down after a quarter of its period; the distance, m.
inline double pendulum_error(const std::string& solver, int steps, const Settings& settings = {}) {
  const Scene scene = chain(1);
  // A quarter of the period 4 sqrt(l / g) K(sin(90 degrees / 2)), with l = 1.
  const double quarter = std::comp_ellint_1(std::sqrt(0.5)) / std::sqrt(9.81);
  const State end = run(solver, scene, quarter / steps, steps, settings);
  return (end.x.col(1) + Eigen::Vector3d::UnitY()).norm();
}

// An impossible step is refused, leaves the state unchanged and does not affect the next step.
inline void expect_refusal_without_trace(const std::string& solver, const Scene& scene,
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

}  // namespace engines
