// What bench tune searches for: settings of a solver on scenes of one kind, judged by the time of
// its best steps at several sizes and strain limits (tune_search.h has the search). At each the
// faster of tuned and untuned counts, as it does in rankings: so a setting may help where it helps,
// and harms nowhere.
#pragma once

#include "harness/points/suite.h"
#include "harness/points/tuned.h"
#include "harness/run/sweep.h"
#include "harness/run/tune_search.h"

namespace harness {

// The scenes that settings are searched on, one a kind, each at two sizes, so that a setting that
// suits one size alone is found out. None of them is in a reported result.
std::vector<SweepSpec> tuning_scenes();

struct TuneOptions {
  TuneRules rules;
  double timeout = 10;  // s, of a run
  std::function<bool()> interrupted = nullptr;
  std::function<void(const std::string&)> tell = [](const std::string&) {};  // lines of progress
};

// Without `context`. No settings where nothing is gained, or the solver fails everywhere as it is.
// Throws Interrupted.
TunedEntry tune_solver(const std::string& solver, const SweepSpec& scene,
                       const TuneOptions& options, const SweepRunners& runners = {});

}  // namespace harness
