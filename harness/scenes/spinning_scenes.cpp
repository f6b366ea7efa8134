// What spins in its plane, free and without weight: each a rigid rotation for ever, held by its
// edges against the centrifugal force.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "harness/scenes/meshes.h"
#include "harness/scenes/rows.h"

namespace harness {
namespace {

using inextensible::Positions;

// rad/s
double turning_rate(const SceneParameters& p) { return 2 * std::numbers::pi * p.at("turns"); }

// Gives each vertex its velocity of the rotation about `axis`, and the mirror of its plane.
void spin(Scene& scene, const Eigen::Vector3d& axis, double omega) {
  for (int i = 0; i < scene.start.x.cols(); ++i)
    scene.start.v.col(i) = omega * axis.cross(Eigen::Vector3d(scene.start.x.col(i)));
  Scene::Mirror plane{axis, {}};
  for (int i = 0; i < scene.start.x.cols(); ++i) plane.image.push_back(i);
  scene.mirrors = {std::move(plane)};
  scene.conserves_energy = true;
}

Positions turned(const Positions& start, const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix() * start;
}

// The square of rest lengths stays one, and its shear springs do nothing.
Scene build_net(const SceneParameters& given) {
  SceneParameters p = given;
  p["gravity"] = 0;
  Draft cloth = vertex_square(p, 0);
  spin(cloth.scene, Eigen::Vector3d::UnitY(), turning_rate(p));
  return finished(std::move(cloth));
}

Positions turned_net(const SceneParameters& p, double time) {
  return turned(build_net(p).start.x, Eigen::Vector3d::UnitY(), turning_rate(p) * time);
}

Scene build_baton(const SceneParameters& given) {
  SceneParameters p = given;
  p["gravity"] = 0;
  Draft row = vertex_row(p);
  const int n = static_cast<int>(p.at("n"));
  for (int i = 0; i < n; ++i) row.scene.start.x(0, i) = 0.5 * row_link(p) * (2 * i - (n - 1));
  spin(row.scene, Eigen::Vector3d::UnitZ(), turning_rate(p));
  return finished(std::move(row));
}

Positions turned_baton(const SceneParameters& p, double time) {
  return turned(build_baton(p).start.x, Eigen::Vector3d::UnitZ(), turning_rate(p) * time);
}

// A regular polygon: all its tensions are m Omega^2 r / (2 sin(pi / n)).
Scene build_hoop(const SceneParameters& p) {
  const int n = static_cast<int>(p.at("n"));
  const double r = p.at("radius"), sector = 2 * std::numbers::pi / n;
  Draft hoop;
  hoop.parts.mass.assign(n, p.at("mass") / n);
  hoop.parts.gravity.setZero();
  hoop.scene.start.x.resize(3, n);
  hoop.scene.start.v.setZero(3, n);
  for (int i = 0; i < n; ++i) {
    hoop.scene.start.x.col(i) << r * std::cos(sector * i), r * std::sin(sector * i), 0;
    hoop.parts.edges.push_back({i, (i + 1) % n});
    hoop.parts.rest_length.push_back(2 * r * std::sin(0.5 * sector));
  }
  hoop.scene.duration = p.at("duration");
  hoop.scene.size = 2 * r;
  spin(hoop.scene, Eigen::Vector3d::UnitZ(), turning_rate(p));
  return finished(std::move(hoop));
}

Positions turned_hoop(const SceneParameters& p, double time) {
  return turned(build_hoop(p).start.x, Eigen::Vector3d::UnitZ(), turning_rate(p) * time);
}

std::pair<int, int> count_hoop(const SceneParameters& p) {
  const int n = static_cast<int>(p.at("n"));
  return {n, n};
}

const SceneParameterInfo turns_info{"turns", 1, "1/s, at the start", 0, 1e4};
const SceneParameterInfo one_second{"duration", 1, "s", 0, 1e4};

}  // namespace

SceneType spinning_net_scene() {
  return {"spinning_net",
          "a square of cloth that spins in its plane, free and without weight: its motion is known",
          "n",
          {{"n", 21, "vertices along each side", 2, 4000, true},
           {"side", 1, "m", 0, 1e6},
           {"mass", 0.2, "total, kg", 0, 1e6},
           {"shear", 0.1, "spring stiffness on both diagonals of each quad, N/m", -1e-300, 1e9},
           turns_info,
           one_second},
          build_net,
          count_square,
          turned_net};
}

SceneType baton_scene() {
  return {"baton",
          "a straight chain that spins about its middle, free and without weight: its motion is "
          "known",
          "n",
          {{"n", 21, "vertices", 2, 10'000'000, true},
           {"length", 1, "m", 0, 1e6},
           {"mass", 1, "total, kg", 0, 1e6},
           turns_info,
           one_second},
          build_baton,
          count_row,
          turned_baton,
          "chain"};
}

SceneType hoop_scene() {
  return {"hoop",
          "a closed chain that spins as a regular polygon, free and without weight: its motion is "
          "known",
          "n",
          {{"n", 40, "vertices", 3, 10'000'000, true},
           {"radius", 0.5, "m", 0, 1e6},
           {"mass", 1, "total, kg", 0, 1e6},
           turns_info,
           one_second},
          build_hoop,
          count_hoop,
          turned_hoop,
          "chain"};
}

}  // namespace harness
