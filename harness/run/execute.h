// How the runs that a plan asks for are carried out: each in its own process, each kept in the
// journal. All runners wrap run_point(); tests replace it with formulas.
#pragma once

#include "harness/base/journal.h"
#include "harness/run/measure_point.h"

namespace harness {

using Runner = std::function<PointResult(const PointSpec&, const RunLimits&)>;

void add_sample(PointResult& point, const Runner& run, RunLimits limits);

// Errors are measured against these references; null: they stay unknown.
Runner with_references(const Runner& inner, std::shared_ptr<ReferenceFolder> references);

// Each run in a child process: a crash, a hang or want of memory is one point's status, with signal
// and step, and the sweep goes on. memory: bytes of address space a point may have, 0: no limit.
// Throws Interrupted at once when the sweep is interrupted.
Runner isolated(const Runner& inner, double memory);

// What the journal knows is not run, and what is run is added to it. A sweep that goes on is run
// once more from its beginning, so that every decision comes out as before, and the rest
// follows. Keys: key_of(spec) for a point with its first sample; that and " #i" for its i-th
// repetition. The journal must outlive the runner.
Runner journaled(const Runner& inner, Journal& journal);

void add_runs_of(const json& result, Journal& journal);
std::size_t points_in(const Journal& journal);  // without repetitions

}  // namespace harness
