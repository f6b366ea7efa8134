// Two programs timed against each other: single points in processes of their own, in interleaved
// pairs, so that what the machine does meanwhile falls on both.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/compare/comparison.h"

namespace harness {

enum class Side { old_one, new_one };

// One point to be timed.
struct PairedPoint {
  nlohmann::json spec;                    // what `bench point` reads, with the point's id
  int samples = 1;                        // runs in one process
  ComparedPoint before = {}, after = {};  // what the processes said; samples: one time a process

  ComparedPoint& said(Side side) { return side == Side::old_one ? before : after; }
};

// Runs one process on one point; what `bench point` printed, all runs among its samples.
using RunOne = std::function<ComparedPoint(Side, const PairedPoint&)>;

// Runs in one process, so that a process measures for at least `least` seconds. seconds: one run.
int samples_for(double seconds, double least);

// `pairs` rounds over all points; the sides take turns in coming first (ABBA). A point that has
// failed on either side is left alone from then on.
void run_pairs(const std::vector<PairedPoint*>& points, int pairs, const RunOne& run);

// run_pairs, then once more, from scratch, with `confirming` pairs for points whose times have
// changed: only what is found both times counts. "Same" is said only where the 95 % interval of the
// times' ratio stays within what the gate lets pass.
Comparison compare_in_pairs(std::vector<PairedPoint> points, int pairs, int confirming,
                            const Gate& gate, const Comparability& can, const RunOne& run);

}  // namespace harness
