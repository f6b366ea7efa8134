// Cloth that a moving body wears: a skirt held by nothing but the body's shape, and a cape pinned
// to it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "harness/scenes/cloth_mesh.h"
#include "solvers/problem/triangle_collider.h"

namespace harness {
namespace {

using std::numbers::pi;

// ---- Bodies ----
struct Ring {
  double y, radius;  // m
};

// Polygons of the profile's rings about the y axis, from the lower end to the upper. The first and
// the last ring are points.
inextensible::TriangleMesh lathed(const std::vector<Ring>& rings, int segments) {
  inextensible::TriangleMesh mesh;
  const auto last = static_cast<int>(rings.size()) - 1;
  const auto vertex = [&](int ring, int segment) {
    if (ring == 0) return 0;
    if (ring == last) return 1;
    return 2 + (ring - 1) * segments + segment % segments;
  };
  mesh.vertices = {{0, rings.front().y, 0}, {0, rings.back().y, 0}};
  for (int r = 1; r < last; ++r)
    for (int s = 0; s < segments; ++s) {
      const double angle = 2 * pi * s / segments;
      mesh.vertices.emplace_back(rings[r].radius * std::cos(angle), rings[r].y,
                                 rings[r].radius * std::sin(angle));
    }
  for (int r = 0; r < last; ++r)
    for (int s = 0; s < segments; ++s) {
      const int a = vertex(r, s), b = vertex(r, s + 1), c = vertex(r + 1, s + 1),
                d = vertex(r + 1, s);
      if (r == 0) {
        mesh.triangles.push_back({a, d, c});
        continue;
      }
      mesh.triangles.push_back({a, d, b});
      if (r + 1 < last) mesh.triangles.push_back({b, d, c});
    }
  return mesh;
}

// A wall between two half ellipsoids of the same radius.
struct Dome {
  double y, height;  // m, of its base, and from there
};
std::vector<Ring> capped(double radius, const Dome& lower, const std::vector<Ring>& wall,
                         const Dome& upper) {
  constexpr int cap = 8;  // rings
  const auto ring = [&](const Dome& dome, int k) -> Ring {
    const double angle = 0.5 * pi * k / cap;
    return {dome.y + dome.height * std::cos(angle), radius * std::sin(angle)};
  };
  std::vector<Ring> rings;
  rings.reserve(wall.size() + 2 * cap + 1);
  for (int k = 0; k < cap; ++k) rings.push_back(ring({lower.y, -lower.height}, k));
  rings.insert(rings.end(), wall.begin(), wall.end());
  for (int k = cap; k >= 0; --k) rings.push_back(ring(upper, k));
  return rings;
}

// A cosine from the hips to the waist and one on to the chest. The waist is at y = 0.
std::vector<Ring> torso(const SceneParameters& p) {
  constexpr int wave = 14;                    // rings
  constexpr double below = 1.6, above = 0.7;  // heights of the ends, of the drop
  const double hips = p.at("hips"), waist = p.at("waist"), drop = p.at("drop");
  std::vector<Ring> wall;
  for (int k = -wave; k < wave; ++k) {
    const double part = static_cast<double>(k) / wave;
    wall.push_back({part * drop, waist + (hips - waist) * 0.5 * (1 - std::cos(pi * part))});
  }
  return capped(hips, {-drop, below * drop}, wall, {drop, above * drop});
}

// A column, as high as the cape is long and a little more. The collar is at y = 0.
std::vector<Ring> column(const SceneParameters& p) {
  constexpr int rings = 16;
  constexpr double above = 0.02, below = 1.1, dome = 0.9;  // m; of the length; of the radius
  const double radius = p.at("body"), top = above, bottom = -below * p.at("length");
  std::vector<Ring> wall(rings);
  for (int k = 0; k < rings; ++k)
    wall[k] = {bottom + (top - bottom) * static_cast<double>(k) / rings, radius};
  return capped(radius, {bottom, dome * radius}, wall, {top, dome * radius});
}

// Moves the body from rest: `place` gives the angle about y and the x and z of its axis.
template <class Place>
void move_body(Draft& draft, double period, const Place& place) {
  draft.scene.energy_bound = std::numeric_limits<double>::infinity();  // the body does work
  draft.parts.body_motion = [=](double time) {
    const double phase = 2 * pi * time / period;
    const double strength = time < 0.5 * period ? 0.5 * (1 - std::cos(phase)) : 1;
    const auto [angle, x, z] = place(strength, phase);
    Pose pose;
    pose.turn << std::cos(angle), 0, std::sin(angle), 0, 1, 0, -std::sin(angle), 0, std::cos(angle);
    pose.translation << x, 0, z;
    return pose;
  };
}

Draft worn(const ClothMesh& cloth, const std::vector<Ring>& body, const SceneParameters& p) {
  Draft draft = cloth_draft(cloth, p);
  draft.parts.collider = std::make_shared<const inextensible::TriangleCollider>(
      lathed(body, whole(p, "segments")), p.at("friction"));
  draft.scene.size = p.at("length");
  return draft;
}

// ---- Cloth ----
// A cone about the y axis that widens downwards from y = 0, or a part of it.
struct Cone {
  double radius, wider;  // m, at the top, and how much wider below
  double length;         // m, along the cloth
  int around, rows;      // vertices
  bool closed;

  Cone(const SceneParameters& p, double top, double covered, const char* what)
      : radius(top),
        wider(top * (p.at("flare") - 1)),
        length(p.at("length")),
        around(whole(p)),
        closed(covered >= 2 * pi) {
    if (!(std::abs(wider) < length))
      throw std::invalid_argument("'flare' of " + std::to_string(p.at("flare")) +
                                  ": the hem is wider than the length of the " + what + " allows");
    const double mean = 0.5 * covered * radius * (1 + p.at("flare"));  // width, m
    const int links = closed ? around : around - 1;
    rows = 1 + std::max(1, static_cast<int>(std::lround(length * links / mean)));
  }

  // Held by nothing. place: x and z of an index around, on the unit circle.
  template <class Place>
  ClothMesh cloth(const Place& place) const {
    const double fall = std::sqrt(length * length - wider * wider);
    ClothMesh mesh;
    for (int r = 0; r < rows; ++r) {
      const double part = static_cast<double>(r) / (rows - 1), width = radius + part * wider;
      for (int s = 0; s < around; ++s) {
        const auto [x, z] = place(s);
        mesh.vertices.emplace_back(width * x, -part * fall, width * z);
        if (r + 1 == rows || (!closed && s + 1 == around)) continue;
        const int next = (s + 1) % around, below = (r + 1) * around;
        mesh.quads.push_back({r * around + s, r * around + next, below + next, below + s});
      }
    }
    mesh.held.assign(mesh.vertices.size(), 0);
    return mesh;
  }
};

// ---- The garment ----
ClothMesh skirt(const SceneParameters& p) {
  const Cone cone(p, p.at("rim"), 2 * pi, "garment");
  return cone.cloth([&](int s) {
    const double angle = 2 * pi * s / cone.around;
    return std::array{std::cos(angle), std::sin(angle)};
  });
}

Scene build_garment(const SceneParameters& p) {
  if (!(p.at("waist") < p.at("rim")))
    throw std::invalid_argument("'rim' of " + std::to_string(p.at("rim")) +
                                " m: must be wider than the waist");
  Draft draft = worn(skirt(p), torso(p), p);
  const double sway = p.at("sway"), turn = p.at("turn");
  if (sway != 0 || turn != 0)
    move_body(draft, p.at("period"), [=](double strength, double phase) {
      const double wave = strength * std::sin(phase);
      return std::array{turn * wave, sway * wave, 0.0};
    });
  draft.scene.marks = {{"rim", 0, 0}, {"rim_across", whole(p) / 2, 0}};
  return finished(std::move(draft));
}

// ---- The cape ----
// Part of a cone about the body: the collar first, of which the vertices within `held` of its
// middle are pinned.
ClothMesh cape(const SceneParameters& p) {
  const Cone cone(p, p.at("body") + p.at("gap"), p.at("spread"), "cape");
  const auto angle = [&](int s) {
    return p.at("spread") * (static_cast<double>(s) / (cone.around - 1) - 0.5);
  };
  ClothMesh cloth = cone.cloth([&](int s) {
    return std::array{std::sin(angle(s)), std::cos(angle(s))};
  });
  for (int s = 0; s < cone.around; ++s) cloth.held[s] = std::abs(angle(s)) <= 0.5 * p.at("held");
  return cloth;
}

Scene build_cape(const SceneParameters& p) {
  Draft draft = worn(cape(p), column(p), p);
  const double walk = p.at("walk"), turn = p.at("turn");
  // A figure of eight on the ground, and a turn to either side.
  move_body(draft, p.at("period"), [=](double strength, double phase) {
    return std::array{strength * turn * std::sin(phase), strength * walk * std::sin(phase),
                      0.5 * strength * walk * std::sin(2 * phase)};
  });
  draft.parts.pins_follow_body = true;
  return finished(std::move(draft));
}

}  // namespace

std::vector<SceneType> worn_scenes() {
  return {
      {.name = "garment",
       .summary = "a skirt held by nothing but its rim, on a body that sways and turns (Figure 7)",
       .parameters = with_cloth_parameters(
           {{"n", 64, "vertices around", 8, 4000, true},
            {"rim", 0.13, "radius of the garment's upper end, which starts at the waist, m", 0,
             1e3},
            {"flare", 1.5, "radius of its lower end over that; 1: a tube", 0, 100},
            {"length", 0.4, "of the garment, m", 0, 1e3},
            {"waist", 0.115, "radius of the body where it is narrowest, m", 0, 1e3},
            {"hips", 0.137, "radius of the body where it is widest, m", 0, 1e3},
            {"drop", 0.12, "from the waist down to the hips, m", 0, 1e3},
            {"segments", 48, "of the body around", 3, 1000, true},
            friction_info(0.2),
            {"sway", 0.06, "how far the body goes to either side, m; 0: not at all", zero_too, 1e3},
            {"turn", 0.6, "how far it turns either way, rad; 0: not at all", zero_too, 10},
            {"period", 1, "of both, s", 0, 1e3}},
           {.density = 0.15, .shear = 5, .bending = 1e-5, .drag = 0.1}, 3),
       .build = build_garment,
       .counts = [](const SceneParameters& p) { return count_cloth(skirt(p)); },
       .like = "drape"},
      {.name = "cape",
       .summary = "a cape, pinned to a body along a short part of its collar; the body walks and "
                  "turns (after Figure 8)",
       .parameters = with_cloth_parameters(
           {{"n", 41, "vertices across", 3, 4000, true},
            {"length", 0.7, "of the cape, m", 0, 1e3},
            {"spread", 2.4, "angle around the body that the cape covers, rad", 0, 6},
            {"flare", 1.8, "radius of the hem over that of the collar", 0, 100},
            {"held", 1.2, "angle of the collar's pinned part, rad", 0, 6},
            {"body", 0.15, "radius of the body, m", 0, 1e3},
            {"gap", 0.004, "between collar and body, m", 0, 1e3},
            {"segments", 48, "of the body around", 3, 1000, true},
            friction_info(0.2),
            {"walk", 0.25, "how far the body goes to either side, m", zero_too, 1e3},
            {"turn", 1.4, "how far it turns either way, rad", zero_too, 10},
            {"period", 2.5, "of both, s", 0, 1e3}},
           {.density = 0.15, .shear = 5, .bending = 1e-5, .drag = 0.3}, 5),
       .build = build_cape,
       .counts = [](const SceneParameters& p) { return count_cloth(cape(p)); },
       .like = "drape"}};
}

}  // namespace harness
