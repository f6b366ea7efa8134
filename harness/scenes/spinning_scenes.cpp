// Bodies that spin in their plane, free and weightless: a perpetual rigid rotation, held by their
// edges against the centrifugal force.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "harness/scenes/meshes.h"

namespace harness {
namespace {

using Eigen::Vector3d;

// rad/s
double turning_rate(const SceneParameters& p) { return 2 * std::numbers::pi * p.at("turns"); }

// Gives each vertex its velocity of the rotation about coordinate axis `axis`.
Scene spinning(Draft draft, int axis, const SceneParameters& p) {
  State& start = draft.scene.start;
  for (int i = 0; i < start.x.cols(); ++i)
    start.v.col(i) = turning_rate(p) * Vector3d::Unit(axis).cross(Vector3d(start.x.col(i)));
  return released(std::move(draft), {});
}

template <Scene (*build)(const SceneParameters&), int axis>
Positions turned_start(const SceneParameters& p, double time) {
  const Eigen::AngleAxisd turn(turning_rate(p) * time, Vector3d::Unit(axis));
  return turn.toRotationMatrix() * build(p).start.x;
}

// The square of rest lengths stays one, and its shear springs do nothing.
Scene build_net(const SceneParameters& p) { return spinning(vertex_square(p, 0), 1, p); }

Scene build_baton(const SceneParameters& p) {
  Draft row = vertex_row(p);
  const int n = whole(p);
  for (int i = 0; i < n; ++i) row.scene.start.x(0, i) = 0.5 * row_link(p) * (2 * i - (n - 1));
  return spinning(std::move(row), 2, p);
}

// A regular polygon: all its tensions are m Omega^2 r / (2 sin(pi / n)).
Scene build_hoop(const SceneParameters& p) {
  const int n = whole(p);
  const double r = p.at("radius"), sector = 2 * std::numbers::pi / n;
  Draft hoop(n, p);
  hoop.parts.mass.assign(n, p.at("mass") / n);
  for (int i = 0; i < n; ++i) {
    hoop.scene.start.x.col(i) << r * std::cos(sector * i), r * std::sin(sector * i), 0;
    hoop.constrain(i, (i + 1) % n, 2 * r * std::sin(0.5 * sector));
  }
  hoop.scene.size = 2 * r;
  return spinning(std::move(hoop), 2, p);
}

const SceneParameterInfo turns_info{"turns", 1, "1/s, at the start", 0, 1e4};

}  // namespace

std::vector<SceneType> spinning_scenes() {
  return {{.name = "spinning_net",
           .summary = "a square of cloth that spins in its plane, free and without weight: its "
                      "motion is known",
           .parameters = {{"n", 21, "vertices along each side", 2, 4000, true},
                          {"side", 1, "m", 0, 1e6},
                          {"mass", 0.2, "total, kg", 0, 1e6},
                          {"shear", 0.1, "spring stiffness on both diagonals of each quad, N/m",
                           zero_too, 1e9},
                          turns_info,
                          duration_info()},
           .build = build_net,
           .counts = count_square,
           .exact = turned_start<build_net, 1>},
          {.name = "baton",
           .summary = "a straight chain that spins about its middle, free and without weight: its "
                      "motion is known",
           .parameters = row_parameters({"n", 21, "vertices", 2, 10'000'000, true}, {turns_info}),
           .build = build_baton,
           .counts = count_row,
           .exact = turned_start<build_baton, 2>,
           .like = "chain"},
          {.name = "hoop",
           .summary = "a closed chain that spins as a regular polygon, free and without weight: "
                      "its motion is known",
           .parameters = {{"n", 40, "vertices", 3, 10'000'000, true},
                          {"radius", 0.5, "m", 0, 1e6},
                          {"mass", 1, "total, kg", 0, 1e6},
                          turns_info,
                          duration_info()},
           .build = build_hoop,
           .counts = [](const SceneParameters& p) { return std::pair(whole(p), whole(p)); },
           .exact = turned_start<build_hoop, 2>,
           .like = "chain"}};
}

}  // namespace harness
