// A sweep with a journal (base/journal.h). A sweep that goes on is run once more from its
// beginning with the journal for a memory: what that knows is not run, so every decision falls as
// it fell before, and the rest follows.
//
// Keys: key_of(spec) for a point with its first sample; that and " #i" for its i-th repetition.
#pragma once

#include "harness/base/journal.h"
#include "harness/run/sweep.h"

namespace harness {

// Runners that look into the journal first, and add to it what `inner` does. The journal must
// outlive them.
SweepRunners journaled(const SweepRunners& inner, Journal& journal);

// Adds the runs of a result file, as if they had just been made.
void add_runs_of(const nlohmann::json& result, Journal& journal);

void forget_failures(Journal& journal);

// Points, without repetitions.
std::size_t points_in(const Journal& journal);

}  // namespace harness
