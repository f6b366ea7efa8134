// Runs a suite's sweeps: for each (scene, size, limit, solver) the best step is searched
// (step_search.h; a step sweep runs the whole ladder). Then the points that may be best (of a step
// sweep: all that ran to the end) are repeated, interleaved in a shuffled order, and the best ones
// chosen by the times of all their samples.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "harness/base/pattern.h"
#include "harness/base/small_runs.h"
#include "harness/points/suite.h"
#include "harness/run/execute.h"

namespace harness {

struct SweepFilters {
  std::optional<Pattern> solver;   // must match the contestant's whole name
  std::optional<Pattern> include;  // must be found in a point's id
  std::optional<Pattern> exclude;  // must not
};

// One best step to be found.
struct Search {
  PointSpec base;              // all but the step
  std::vector<double> ladder;  // s, coarse to fine; those that the filters leave
  // Rungs to a halving: every stride-th is one of coarsest / 2^k, those between are steps that a
  // best step is refined by.
  std::size_t stride = 1;
  // Searches of one family (same sweep, scene, size and contestant) come from loose to tight; each
  // starts from the step that was best in the one before.
  std::size_t family = 0;
  bool every_step = false;  // the whole ladder, whatever the times are
};

// Throws UsageError if no point is left.
std::vector<Search> plan(const Suite& suite, const SweepFilters& filters);

// All searches of one (sweep, scene, size) are in one part, large sizes spread first, so that no
// comparison crosses machines; possibly none. The parts of a plan are the whole, and a search does
// not depend on the part it is in.
std::vector<Search> shard(std::vector<Search> searches, const Shard& part);

struct Estimate {
  double seconds = 0;  // of the sweep
  int timed = 0;       // (scene, size, contestant)s, a few steps of each
};

// From a few steps of each contestant at each size, taking every search for what most searches are:
// a handful of runs, and repetitions of one. Within a factor of three, mostly.
Estimate estimate(const Suite& suite, const std::vector<Search>& searches);

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
                       const SweepEvents& events, const Runner& run = run_point);

}  // namespace harness
