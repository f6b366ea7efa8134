// What bench tune searches for: settings of a solver on scenes of one kind, at several sizes and
// strain limits, each for itself: best relaxations and numbers of passes depend on both. A set is
// judged by the time of the fastest step whose motion is right to the headline's error
// (tune_search.h has the search; where there is no reference, any motion counts). What was found at
// one place is the first guess at the next.
#pragma once

#include "harness/points/suite.h"
#include "harness/points/tuned.h"
#include "harness/run/sweep.h"
#include "harness/run/tune_search.h"

namespace harness {

struct TuneOptions {
  TuneRules rules;
  int trials_each = 10;  // of rules.budget at most so many for each setting
  double timeout = 10;   // s, of a run
  // Where a solver's best run takes longer than this, as it is and with what was found at the place
  // before, the place is taken at a smaller size.
  double longest_run = 0.25;  // s
  std::function<bool()> interrupted = nullptr;
  std::function<void(const std::string&)> tell = [](const std::string&) {};  // lines of progress
};

// Without `context`. A place has no settings where nothing is gained, and is left out where the
// solver fails as it is. known: settings of other places; each search begins with those of the
// nearest one instead of the solver's own, and must better them. Throws Interrupted.
TunedEntry tune_solver(const std::string& solver, const SweepSpec& scene, TuneOptions options,
                       const SweepRunners& runners = {}, const TunedEntry* known = nullptr);

}  // namespace harness
