// What bench tune searches for: settings of a solver on scenes of one kind, judged by the time of
// the fastest step whose motion is right to the headline's error, at several sizes and strain
// limits (tune_search.h has the search; where there is no reference, any motion counts). At each
// place the faster of tuned and untuned counts, as it does in rankings: so a setting may help where
// it helps, and harms nowhere.
#pragma once

#include "harness/points/suite.h"
#include "harness/points/tuning_rule.h"
#include "harness/run/sweep.h"
#include "harness/run/tune_search.h"

namespace harness {

struct TuneOptions {
  TuneRules rules;
  int trials_each = 10;  // of rules.budget at most so many for each setting
  double timeout = 10;   // s, of a run
  // Where a solver's best run takes longer than this as it is, the place is taken at a smaller
  // size.
  double longest_run = 0.25;  // s
  std::function<bool()> interrupted = nullptr;
  std::function<void(const std::string&)> tell = [](const std::string&) {};  // lines of progress
};

// Without `context`. No settings where nothing is gained, or the solver fails everywhere as it is.
// Throws Interrupted.
TunedEntry tune_solver(const std::string& solver, const SweepSpec& scene,
                       const TuneOptions& options, const SweepRunners& runners = {});

}  // namespace harness
