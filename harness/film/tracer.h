// Pictures of a cloth and a body by ray tracing (Embree): smooth normals, one soft light, light
// from all of the sky where nothing is in its way, and yarns as lines on the cloth.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "harness/film/view.h"

namespace harness {

// What a picture shows at one time.
struct Shot {
  inextensible::Positions cloth;              // m
  std::vector<std::array<int, 3>> triangles;  // of the cloth; none: edges are drawn, as a rope
  std::vector<std::array<int, 2>> edges;      // of a rope
  std::vector<std::uint8_t> drawn_sides;      // of each triangle (weave.h)
  Eigen::Matrix3Xd colours;                   // of each vertex, linear, 0 to 1
  inextensible::Positions body;               // m; empty: none
  std::vector<std::array<int, 3>> body_triangles;
  double yarn = 0;       // half the width of a line, or the radius of a rope, m
  double thickness = 0;  // so far the cloth may lie inside the body, and is seen nevertheless, m
};

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows from above, sRGB
};

// Samples a pixel: samples x samples. Every pixel takes the same pattern of rays, so that flat
// cloth has one shade. Usable from several threads.
Pixels trace(const Shot& shot, const View& view, int width, int samples);

}  // namespace harness
