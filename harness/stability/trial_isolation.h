// A trial in a child process: a crash or a hang is its outcome.
#pragma once

#include "harness/stability/trial.h"

namespace harness {

// run_trial() in a child; Outcome::crashed if it does not come back.
TrialResult run_isolated_trial(const std::function<Trial()>& build, const std::string& solver,
                               std::uint64_t seed);

}  // namespace harness
