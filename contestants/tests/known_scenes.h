// Scenes whose motion, or part of it, theory knows, and what the tests of engines share.
#pragma once

#include <memory>
#include <string>

#include "solvers/registry.h"

namespace engines {

struct Scene {
  std::shared_ptr<const inextensible::Problem> problem;
  inextensible::State start;
};

// `links` equal links of 1 m and 1 kg in all, straight, pinned at the origin, at rest. Along x,
// turned about y by `turn`.
Scene chain(int links, double turn = 0);
// The same, straight down.
Scene hanging_chain(int links);
// The same, bent and moving in all directions, every link at its length.
Scene swirling_chain(int links);
// n x n vertices of 1 kg and 1 m x 1 m in all, without weight, that spin about y by `omega`.
Scene spinning_net(int n, double omega);

// Makes a stepper of the plug-in with this name, and loads the plug-in first.
std::unique_ptr<inextensible::Stepper> make(const std::string& solver, const Scene& scene,
                                            const inextensible::Settings& settings = {});
// The state after that many steps, all of which must be taken.
inextensible::State run(const std::string& solver, const Scene& scene, double h, int steps,
                        const inextensible::Settings& settings = {});

double energy(const Scene& scene, const inextensible::State& state);
Eigen::Vector3d angular_momentum(const Scene& scene, const inextensible::State& state);
double largest_strain(const Scene& scene, const inextensible::State& state);
double distance(const inextensible::Positions& a, const inextensible::Positions& b);

// ---- What every engine must fulfil; they report to GoogleTest ----
// A link that is released level hangs down after a quarter of its period; the distance, m.
double pendulum_error(const std::string& solver, int steps,
                      const inextensible::Settings& settings = {});
// An impossible step is refused, leaves the state as it was, and nothing behind for the next.
void expect_refusal_without_trace(const std::string& solver, const Scene& scene,
                                  const inextensible::State& impossible, double h);
// For engines of first order that take vertices: the error of a pendulum halves with the step; what
// flies freely goes on as it was, momentum and all, and never falls asleep; and two vertices on a
// spring alone swing with omega^2 = 2 k / m, and keep their middle.
void expect_first_order(const std::string& solver);
void expect_free_flight(const std::string& solver);
void expect_spring(const std::string& solver);
// make() refuses, and says why.
void expect_unsupported(const std::string& solver, const Scene& scene, const std::string& why);

}  // namespace engines
