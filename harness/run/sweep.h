// Runs a suite's sweeps: for each (scene, size, limit, solver) the best step is searched on the
// ladder coarsest, coarsest / 2, ... (a step sweep runs the whole ladder), then the best points (of
// a step sweep: all that ran to the end) are repeated, interleaved in a shuffled order.
#pragma once

#include <functional>
#include <optional>
#include <regex>
#include <vector>

#include "harness/points/suite.h"
#include "harness/run/runner.h"

namespace harness {

struct SweepFilters {
  std::optional<std::regex> solver;   // must match the solver's whole name
  std::optional<std::regex> include;  // must be found in a point's id
  std::optional<std::regex> exclude;  // must not
};

// One best step to be found.
struct Search {
  PointSpec base;              // all but the step
  std::vector<double> ladder;  // s, coarse to fine; those that the filters leave
  // Searches of one family (same sweep, scene, size and solver) come from loose to tight; each
  // starts from the step that was best in the one before.
  std::size_t family = 0;
  bool every_step = false;  // the whole ladder, whatever the times are
};

// Throws UsageError if no point is left.
std::vector<Search> plan(const Suite& suite, const SweepFilters& filters);

// The index-th, from 1 on, of count parts.
struct Shard {
  std::size_t index = 1, count = 1;
};
// All searches of one (sweep, scene, size) are in one part, large sizes spread first, so that no
// comparison crosses machines; possibly none. The parts of a plan are the whole, and a search does
// not depend on the part it is in.
std::vector<Search> shard(std::vector<Search> searches, const Shard& part);

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

// run and repeat stand for run_point and repeat_point; tests put a fake clock there.
struct SweepRunners {
  std::function<PointResult(const PointSpec&, const RunLimits&, std::optional<double>)> run =
      run_point;
  std::function<void(PointResult&, const RunLimits&)> repeat = repeat_point;
  std::shared_ptr<ReferenceShelf> references = nullptr;  // null: no errors against references
};

SweepOutcome run_sweep(const Suite& suite, const std::vector<Search>& searches,
                       const SweepEvents& events, const SweepRunners& runners = {});

}  // namespace harness
