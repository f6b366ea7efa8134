// Every point in a child process of its own: a crash, a hang or want of memory is one point's
// status, with signal and step, and the sweep goes on.
#pragma once

#include "sweep.h"
#include "trial.h"

namespace harness {

// Runners that do what `inner` does, each call in a child. memory: bytes of address space a point
// may have, 0: no limit. A run of theirs throws Interrupted at once when the sweep is interrupted.
SweepRunners isolated(const SweepRunners& inner, double memory);

// run_trial() in a child; Outcome::crashed if it does not come back.
TrialResult run_isolated_trial(const std::function<Trial()>& build, const std::string& solver,
                               std::uint64_t seed);

}  // namespace harness
