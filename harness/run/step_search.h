// The search for a solver's best steps.
#pragma once

#include "harness/points/point.h"

namespace harness {

// The rule is in docs/measuring.md ("The time step"). From a neighbour's best step the search goes
// in both directions. A failure counts as a rise, and before the first success as a reason to go
// finer. Where a best step is an end of what was tried, the search continues from there.
inline constexpr std::size_t samples_when_close = 3;

struct StepLadder {
  std::size_t rungs = 0;
  // The rung's point, which is run when it is first asked for. A run that takes longer than
  // `useful` seconds per simulated second is of no use to the search.
  std::function<const PointResult&(std::size_t rung, double useful)> run;
  // Takes one sample more of a rung, if it can have one.
  std::function<void(std::size_t rung)> again;
  std::vector<double> levels = {};        // of error, loose to tight; none: any motion alone
  std::size_t stride = 1;                 // of the rungs that halve the step
  std::optional<std::size_t> start = {};  // the rung to begin from
  bool every_step = false;                // all from coarse to fine, until two in a row time out
};

struct BestSteps {
  std::optional<std::size_t> best;  // the best rung of any motion; none if every step failed
  bool timed_out = false;           // every step that was tried was stopped by its time-out
  // By level (any_motion: all that ran to the end) and rung; no level is empty.
  std::map<double, std::map<std::size_t, double>> seconds;
};

BestSteps find_best_steps(const StepLadder& ladder);

}  // namespace harness
