// Runs a suite's sweeps. For each (scene, size, limit, solver) the best step is found
// (step_search.h; a step sweep runs the whole ladder). Points that may be best (in a step sweep:
// all that succeeded) are repeated in a shuffled order, and the best chosen from all samples.
#pragma once

#include "harness/points/suite.h"
#include "harness/run/execute.h"

namespace harness {

struct SweepFilters {
  std::optional<Pattern> solver;   // must match the contestant's whole name
  std::optional<Pattern> include;  // must be found in a point's id
  std::optional<Pattern> exclude;  // must not be found there
};

// One best step to be found.
struct Search {
  PointSpec base;              // all but the step
  std::vector<double> ladder;  // s, coarse to fine, as far as the filters allow
  // Every stride-th rung is coarsest / 2^k; those in between refine a best step.
  std::size_t stride = 1;
  // Searches of one family (same sweep, scene, size and contestant) are ordered from loose to tight
  // limits; each starts from the best step of the previous one.
  std::size_t family = 0;
  bool every_step = false;  // the whole ladder, whatever the times are
};

// Throws UsageError if no point is left.
std::vector<Search> plan(const Suite& suite, const SweepFilters& filters);

struct Estimate {
  double seconds = 0;  // of the sweep
  int timed = 0;       // combinations of scene, size and contestant that took a few steps
};

// From a few steps of each contestant and size. Mostly right within a factor of three.
Estimate estimate(const Suite& suite, const std::vector<Search>& searches);

// s. Runs that have taken this long are not repeated: disturbances average out within long runs.
inline constexpr double repeat_for = 10;

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

// Samples of these points on another occasion, in a shuffled order; as many of each as a sweep
// takes of a point that may be best, none of one that no longer runs to its end. Throws
// Interrupted.
std::vector<Samples> time_again(const Suite& suite, const std::vector<PointResult>& points,
                                const SweepEvents& events, const Runner& run);

}  // namespace harness
