#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "harness/base/fit.h"
#include "harness/points/point.h"

namespace harness {

// How the time of a step grows with the vertices: of the best points of one solver in a resolution
// sweep.
struct Growth {
  std::string solver;
  Slope exponent;
  const PointResult *smallest, *largest;  // of those that count
};
// One for each solver with best points at two sizes at least, in the order of `points`, which are
// those of one sweep.
std::vector<Growth> growths(const std::vector<const PointResult*>& points);

// Their table, with what explains the time of the largest size.
void print_growth(std::ostream& out, const std::vector<const PointResult*>& points);

}  // namespace harness
