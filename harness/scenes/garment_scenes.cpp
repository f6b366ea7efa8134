// A garment that a body holds by nothing but its shape.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "harness/scenes/cloth_draft.h"
#include "harness/scenes/rows.h"
#include "harness/scenes/turned_body.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// The body's profile, from the lower end to the upper: half an ellipsoid, a cosine from the hips to
// the waist and one on to the chest, half an ellipsoid. The waist is at y = 0.
std::vector<Ring> profile(const SceneParameters& p) {
  constexpr int cap = 8, wave = 14;           // rings
  constexpr double below = 1.6, above = 0.7;  // heights of the ends, of the drop
  const double hips = p.at("hips"), waist = p.at("waist"), drop = p.at("drop");
  std::vector<Ring> rings;
  for (int k = 0; k < cap; ++k) {
    const double angle = 0.5 * pi * k / cap;
    rings.push_back({-drop - below * drop * std::cos(angle), hips * std::sin(angle)});
  }
  for (int k = -wave; k < wave; ++k) {
    const double part = static_cast<double>(k) / wave;
    rings.push_back({part * drop, waist + (hips - waist) * 0.5 * (1 - std::cos(pi * part))});
  }
  for (int k = cap; k >= 0; --k) {
    const double angle = 0.5 * pi * k / cap;
    rings.push_back({drop + above * drop * std::cos(angle), hips * std::sin(angle)});
  }
  return rings;
}

// Oscillates along x and turns about y, from rest.
inextensible::BodyMotion swaying(const SceneParameters& p) {
  const double sway = p.at("sway"), turn = p.at("turn"), period = p.at("period");
  return [=](double time) {
    const double phase = 2 * pi * time / period;
    const double strength = time < 0.5 * period ? 0.5 * (1 - std::cos(phase)) : 1;
    const double wave = strength * std::sin(phase), angle = turn * wave;
    inextensible::Pose pose;
    pose.turn << std::cos(angle), 0, std::sin(angle), 0, 1, 0, -std::sin(angle), 0, std::cos(angle);
    pose.translation << sway * wave, 0, 0;
    return pose;
  };
}

int rings_of(const SceneParameters& p) {
  const double mean = pi * p.at("rim") * (1 + p.at("flare"));  // circumference, m
  return 1 + std::max(1, static_cast<int>(std::lround(p.at("length") * p.at("n") / mean)));
}

// Rings of n vertices, the rim first, on a cone that widens downwards.
ClothMesh cone(const SceneParameters& p) {
  const auto n = static_cast<int>(p.at("n"));
  const int rings = rings_of(p);
  const double rim = p.at("rim"), length = p.at("length"), wider = rim * (p.at("flare") - 1);
  if (!(std::abs(wider) < length))
    throw std::invalid_argument("'flare' of " + std::to_string(p.at("flare")) +
                                ": the hem is wider than the length of the garment allows");
  const double fall = std::sqrt(length * length - wider * wider);
  ClothMesh mesh;
  for (int r = 0; r < rings; ++r) {
    const double part = static_cast<double>(r) / (rings - 1);
    for (int s = 0; s < n; ++s) {
      const double angle = 2 * pi * s / n, radius = rim + part * wider;
      mesh.vertices.emplace_back(radius * std::cos(angle), -part * fall, radius * std::sin(angle));
      if (r + 1 == rings) continue;
      const int next = (s + 1) % n;
      mesh.quads.push_back({r * n + s, r * n + next, (r + 1) * n + next, (r + 1) * n + s});
    }
  }
  return mesh;
}

Scene build_garment(const SceneParameters& p) {
  if (!(p.at("waist") < p.at("rim")))
    throw std::invalid_argument("'rim' of " + std::to_string(p.at("rim")) +
                                " m: must be wider than the waist");
  ClothMesh mesh = cone(p);
  std::vector<char> free(mesh.vertices.size(), 0);
  Draft draft = cloth_draft({std::move(mesh), std::move(free)}, p);
  draft.parts.collider = std::make_shared<const inextensible::TriangleCollider>(
      turned(profile(p), static_cast<int>(p.at("segments"))), p.at("friction"));
  if (p.at("sway") != 0 || p.at("turn") != 0) {
    draft.parts.body_motion = swaying(p);
    draft.scene.energy_bound = std::numeric_limits<double>::infinity();  // the body does work
  }
  draft.scene.size = p.at("length");
  const auto n = static_cast<int>(p.at("n"));
  draft.scene.marks = {{"rim", 0, 0}, {"rim_across", n / 2, 0}};
  return finished(std::move(draft));
}

std::pair<int, int> count_garment(const SceneParameters& p) {
  const int n = static_cast<int>(p.at("n")), rings = rings_of(p);
  return {n * rings, n * rings + n * (rings - 1)};
}

}  // namespace

SceneType garment_scene() {
  return {
      "garment",
      "a skirt held by nothing but its rim, on a body that sways and turns (Figure 7)",
      "n",
      with_cloth_parameters(
          {{"n", 64, "vertices around", 8, 4000, true},
           {"rim", 0.13, "radius of the garment's upper end, which starts at the waist, m", 0, 1e3},
           {"flare", 1.5, "radius of its lower end over that; 1: a tube", 0, 100},
           {"length", 0.4, "of the garment, m", 0, 1e3},
           {"waist", 0.115, "radius of the body where it is narrowest, m", 0, 1e3},
           {"hips", 0.137, "radius of the body where it is widest, m", 0, 1e3},
           {"drop", 0.12, "from the waist down to the hips, m", 0, 1e3},
           {"segments", 48, "of the body around", 3, 1000, true},
           {"friction", 0.2, "Coulomb coefficient", -1e-300, 1e3},
           {"sway", 0.06, "how far the body goes to either side, m; 0: not at all", -1e-300, 1e3},
           {"turn", 0.6, "how far it turns either way, rad; 0: not at all", -1e-300, 10},
           {"period", 1, "of both, s", 0, 1e3}},
          {.density = 0.15, .shear = 5, .bending = 1e-5, .drag = 0.1, .duration = 3}),
      build_garment,
      count_garment,
      nullptr,
      "drape"};
}

}  // namespace harness
