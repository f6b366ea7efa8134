// Bodies with an axis, as from a lathe.
#pragma once

#include <vector>

#include "solvers/problem/triangle_collider.h"

namespace harness {

struct Ring {
  double y, radius;  // m
};

// Polygons of the profile's rings about the y axis, from the lower end to the upper. The first and
// the last ring are points.
inextensible::TriangleMesh turned(const std::vector<Ring>& rings, int segments);

}  // namespace harness
