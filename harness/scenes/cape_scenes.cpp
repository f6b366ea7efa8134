// A cape that a body wears while it walks and turns.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "harness/scenes/cloth_draft.h"
#include "harness/scenes/rows.h"
#include "harness/scenes/turned_body.h"

namespace harness {
namespace {

using std::numbers::pi;

// A column with rounded ends, as high as the cape is long and a little more. The collar is at
// y = 0.
inextensible::TriangleMesh column(const SceneParameters& p) {
  constexpr int cap = 8, wall = 16;                        // rings
  constexpr double above = 0.02, below = 1.1, dome = 0.9;  // m; of the length; of the radius
  const double radius = p.at("body"), top = above, bottom = -below * p.at("length");
  std::vector<Ring> rings;
  for (int k = 0; k < cap; ++k) {
    const double angle = 0.5 * pi * k / cap;
    rings.push_back({bottom - dome * radius * std::cos(angle), radius * std::sin(angle)});
  }
  for (int k = 0; k < wall; ++k)
    rings.push_back({bottom + (top - bottom) * static_cast<double>(k) / wall, radius});
  for (int k = cap; k >= 0; --k) {
    const double angle = 0.5 * pi * k / cap;
    rings.push_back({top + dome * radius * std::cos(angle), radius * std::sin(angle)});
  }
  return turned(rings, static_cast<int>(p.at("segments")));
}

// A figure of eight on the ground, from rest on, and a turn to either side.
inextensible::BodyMotion walking(const SceneParameters& p) {
  const double walk = p.at("walk"), turn = p.at("turn"), period = p.at("period");
  return [=](double time) {
    const double phase = 2 * pi * time / period;
    const double strength = time < 0.5 * period ? 0.5 * (1 - std::cos(phase)) : 1;
    const double angle = strength * turn * std::sin(phase);
    inextensible::Pose pose;
    pose.turn << std::cos(angle), 0, std::sin(angle), 0, 1, 0, -std::sin(angle), 0, std::cos(angle);
    pose.translation << strength * walk * std::sin(phase), 0,
        0.5 * strength * walk * std::sin(2 * phase);
    return pose;
  };
}

double collar(const SceneParameters& p) { return p.at("body") + p.at("gap"); }  // radius, m

int rows_of(const SceneParameters& p) {
  const double mean = p.at("spread") * collar(p) * 0.5 * (1 + p.at("flare"));  // width, m
  return 1 + std::max(1, static_cast<int>(std::lround(p.at("length") * (p.at("n") - 1) / mean)));
}

// Part of a cone about the body: rows of n vertices, the collar first. Of the collar the vertices
// within `held` of its middle are pinned.
PinnedMesh cape(const SceneParameters& p) {
  const auto n = static_cast<int>(p.at("n"));
  const int rows = rows_of(p);
  const double length = p.at("length"), wider = collar(p) * (p.at("flare") - 1);
  if (!(std::abs(wider) < length))
    throw std::invalid_argument("'flare' of " + std::to_string(p.at("flare")) +
                                ": the hem is wider than the length of the cape allows");
  const double fall = std::sqrt(length * length - wider * wider);
  PinnedMesh cloth;
  for (int r = 0; r < rows; ++r) {
    const double part = static_cast<double>(r) / (rows - 1), radius = collar(p) + part * wider;
    for (int s = 0; s < n; ++s) {
      const double angle = p.at("spread") * (static_cast<double>(s) / (n - 1) - 0.5);
      cloth.mesh.vertices.emplace_back(radius * std::sin(angle), -part * fall,
                                       radius * std::cos(angle));
      cloth.held.push_back(r == 0 && std::abs(angle) <= 0.5 * p.at("held") ? 1 : 0);
      if (r + 1 == rows || s + 1 == n) continue;
      cloth.mesh.quads.push_back({r * n + s, r * n + s + 1, (r + 1) * n + s + 1, (r + 1) * n + s});
    }
  }
  return cloth;
}

Scene build_cape(const SceneParameters& p) {
  Draft draft = cloth_draft(cape(p), p);
  draft.parts.collider =
      std::make_shared<const inextensible::TriangleCollider>(column(p), p.at("friction"));
  draft.parts.body_motion = walking(p);
  draft.parts.pins_follow_body = true;
  draft.scene.energy_bound = std::numeric_limits<double>::infinity();  // the body does work
  draft.scene.size = p.at("length");
  return finished(std::move(draft));
}

std::pair<int, int> count_cape(const SceneParameters& p) { return count_cloth(cape(p)); }

}  // namespace

SceneType cape_scene() {
  return {"cape",
          "a cape, pinned to a body along a short part of its collar; the body walks and turns "
          "(after Figure 8)",
          "n",
          with_cloth_parameters(
              {{"n", 41, "vertices across", 3, 4000, true},
               {"length", 0.7, "of the cape, m", 0, 1e3},
               {"spread", 2.4, "angle around the body that the cape covers, rad", 0, 6},
               {"flare", 1.8, "radius of the hem over that of the collar", 0, 100},
               {"held", 1.2, "angle of the collar's pinned part, rad", 0, 6},
               {"body", 0.15, "radius of the body, m", 0, 1e3},
               {"gap", 0.004, "between collar and body, m", 0, 1e3},
               {"segments", 48, "of the body around", 3, 1000, true},
               {"friction", 0.2, "Coulomb coefficient", -1e-300, 1e3},
               {"walk", 0.25, "how far the body goes to either side, m", -1e-300, 1e3},
               {"turn", 1.4, "how far it turns either way, rad", -1e-300, 10},
               {"period", 2.5, "of both, s", 0, 1e3}},
              {.density = 0.15, .shear = 5, .bending = 1e-5, .drag = 0.3, .duration = 5}),
          build_cape,
          count_cape,
          nullptr,
          "drape"};
}

}  // namespace harness
