#include "harness/scenes/meshes.h"

#include <cmath>

namespace harness {

Draft::Draft(int vertices, const SceneParameters& p) {
  parts.gravity = {0, -value_or_zero(p, "gravity"), 0};
  scene.start.x.setZero(3, vertices);
  scene.start.v.setZero(3, vertices);
  scene.duration = p.at("duration");
}

void Draft::constrain(int a, int b, double length) {
  parts.edges.push_back({a, b});
  parts.rest_length.push_back(length);
}

Scene finished(Draft draft) {
  draft.scene.problem = std::make_shared<const inextensible::Problem>(std::move(draft.parts));
  return std::move(draft.scene);
}

Scene released(Draft draft, std::vector<int> pinned) {
  draft.parts.pinned = std::move(pinned);
  draft.scene.conserves_energy = true;
  return finished(std::move(draft));
}

Draft vertex_row(const SceneParameters& p) {
  const int n = whole(p);
  Draft row(n, p);
  row.parts.mass.assign(n, p.at("mass") / n);
  for (int i = 1; i < n; ++i) row.constrain(i - 1, i, row_link(p));
  row.scene.size = p.at("length");
  return row;
}

Draft vertex_square(const SceneParameters& p, double y) {
  const int n = whole(p);
  const double side = p.at("side"), l = square_link(p);
  Draft square(n * n, p);
  inextensible::ProblemParts& parts = square.parts;
  Scene& scene = square.scene;
  const bool fabric = p.contains("density");
  const double mass = fabric ? p.at("density") * side * side : p.at("mass");
  parts.mass.assign(n * n, mass / (n * n));
  const auto vertex = [n](int i, int j) { return i * n + j; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      // (2 j - (n - 1)) is exactly antisymmetric, so that the start is mirror symmetric to the last
      // bit.
      scene.start.x.col(vertex(i, j)) << 0.5 * l * (2 * j - (n - 1)), y,
          0.5 * l * (2 * i - (n - 1));
      if (j + 1 < n) square.constrain(vertex(i, j), vertex(i, j + 1), l);  // weft
      if (i + 1 < n) square.constrain(vertex(i, j), vertex(i + 1, j), l);  // warp
    }
  inextensible::Springs diagonals;
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const int a = vertex(i, j), b = vertex(i, j + 1), c = vertex(i + 1, j),
                d = vertex(i + 1, j + 1);
      diagonals.edges.insert(diagonals.edges.end(), {{a, d}, {b, c}});
      scene.triangles.insert(scene.triangles.end(), {{a, b, c}, {d, c, b}});
    }
  if (p.at("shear") > 0) {
    diagonals.rest_length.assign(diagonals.edges.size(), std::sqrt(2.0) * l);
    diagonals.stiffness.assign(diagonals.edges.size(), p.at("shear"));
    parts.shear = std::move(diagonals);
  }
  const double bending = value_or_zero(p, "bending"), drag = value_or_zero(p, "drag");
  for (int i = 0; bending > 0 && i < n; ++i) {
    // A yarn's rigidity is the cloth's times the width that falls to it: half along the edges.
    const double rigidity = bending * (i == 0 || i == n - 1 ? 0.5 * l : l);
    const auto bend = [&](int a, int b, int c) {
      parts.bending.push_back(inextensible::yarn_bending(a, b, c, l, l, rigidity));
    };
    for (int j = 0; j + 2 < n; ++j) {
      bend(vertex(i, j), vertex(i, j + 1), vertex(i, j + 2));
      bend(vertex(j, i), vertex(j + 1, i), vertex(j + 2, i));
    }
  }
  if (drag > 0) parts.drag.assign(n * n, drag * l * l);
  parts.implicit_forces = fabric;
  scene.size = side;
  return square;
}

double row_link(const SceneParameters& p) { return p.at("length") / (whole(p) - 1); }

double square_link(const SceneParameters& p) { return p.at("side") / (whole(p) - 1); }

std::pair<int, int> count_row(const SceneParameters& p) {
  const int n = whole(p);
  return {n, n - 1};
}

std::pair<int, int> count_square(const SceneParameters& p) {
  const int n = whole(p);
  return {n * n, 2 * n * (n - 1)};
}

}  // namespace harness
