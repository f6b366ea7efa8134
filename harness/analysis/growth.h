// How the time of a step grows with the number of vertices, in resolution sweeps.
#pragma once

#include <string>
#include <vector>

#include "harness/analysis/plane.h"
#include "harness/base/statistics.h"

namespace harness::analysis {

// Growth of one row of the ranking, at its fastest runs for any motion.
struct RowGrowth {
  std::string row;
  Slope exponent;           // of the time of a step over the number of vertices
  Point smallest, largest;  // runs of the least and the most vertices
};

struct Growth {
  std::string scene;
  double strain_limit = 0;
  std::vector<RowGrowth> rows;  // with runs at two sizes at least; slowest growth first
};

// One for each scene and strain limit that resolution sweeps have.
std::vector<Growth> growth_in(const std::vector<Plane>& planes);

// "1.13 (1.05 to 1.21)"; without an interval where two sizes are all.
std::string exponent_words(const Slope& exponent);

}  // namespace harness::analysis
