#include "harness/scenes/turned_body.h"

#include <cmath>
#include <numbers>

namespace harness {

using std::numbers::pi;

inextensible::TriangleMesh turned(const std::vector<Ring>& rings, int segments) {
  inextensible::TriangleMesh mesh;
  const auto last = static_cast<int>(rings.size()) - 1;
  const auto vertex = [&](int ring, int segment) {
    if (ring == 0) return 0;
    if (ring == last) return 1;
    return 2 + (ring - 1) * segments + segment % segments;
  };
  mesh.vertices = {{0, rings.front().y, 0}, {0, rings.back().y, 0}};
  for (int r = 1; r < last; ++r) {
    for (int s = 0; s < segments; ++s) {
      const double angle = 2 * pi * s / segments;
      mesh.vertices.emplace_back(rings[r].radius * std::cos(angle), rings[r].y,
                                 rings[r].radius * std::sin(angle));
    }
  }
  for (int r = 0; r < last; ++r) {
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
  }
  return mesh;
}

}  // namespace harness
