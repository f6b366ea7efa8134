// Runs a suite's sweeps: for each (scene, size, limit, solver) the best step is searched on the
// ladder coarsest, coarsest / 2, ... (a step sweep runs the whole ladder), for any motion and for
// each level of error. Then the points that may be best at one of them (of a step sweep: all that
// ran to the end) are repeated, interleaved in a shuffled order, and the best ones chosen by the
// times of all their samples.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "harness/run/execute.h"
#include "harness/run/plan.h"

namespace harness {

// A point is not repeated any more when its runs have taken so long together: what disturbs a
// machine averages out within long runs. s.
inline constexpr double repeat_for = 10;

// What a sweep tells while it runs.
struct SweepEvents {
  std::function<void(const PointResult&, std::size_t search, std::size_t searches)> point =
      [](auto&&...) {};
  std::function<void(std::size_t done, std::size_t all)> repetition = [](auto&&...) {};
  std::function<bool()> interrupted = [] { return false; };
};

struct SweepOutcome {
  std::vector<PointResult> points;
  bool complete = true;  // false: interrupted
};

SweepOutcome run_sweep(const Suite& suite, const std::vector<Search>& searches,
                       const SweepEvents& events, const SweepRunners& runners = {});

}  // namespace harness
