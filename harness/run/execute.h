// How the runs that a plan asks for are carried out: each in a process of its own, each kept in the
// journal, under limits of their own. All are wrappers of the same function.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "harness/base/journal.h"
#include "harness/run/measure_point.h"

namespace harness {

// Tests put a fake clock there.
struct SweepRunners {
  std::function<PointResult(const PointSpec&, const RunLimits&, std::optional<double>)> run =
      run_point;
  std::shared_ptr<ReferenceFolder> references = nullptr;  // null: no errors against references

  void add_sample(PointResult& point, RunLimits limits) const {
    limits.sample_of = &point;
    append(run(point.spec, limits, {}), point);
  }
};

// The same with something done around each run. around(spec, limits, call): call(limits) is the
// run, under limits of around's choice.
template <class Around>
SweepRunners wrapped(const SweepRunners& inner, const Around& around) {
  return {[around, run = inner.run](const PointSpec& spec, const RunLimits& limits, auto guess) {
            return around(spec, limits,
                          [&](const RunLimits& own) { return run(spec, own, guess); });
          },
          inner.references};
}

// Each run in a child process: a crash, a hang or want of memory is one point's status, with signal
// and step, and the sweep goes on. memory: bytes of address space a point may have, 0: no limit.
// Throws Interrupted at once when the sweep is interrupted.
SweepRunners isolated(const SweepRunners& inner, double memory);

// What the journal knows is not run, and what is run is added to it. A sweep that goes on is run
// once more from its beginning, so that every decision falls as it fell before, and the rest
// follows. Keys: key_of(spec) for a point with its first sample; that and " #i" for its i-th
// repetition. The journal must outlive the runners.
SweepRunners journaled(const SweepRunners& inner, Journal& journal);

// Adds the runs of a result file, as if they had just been made.
void add_runs_of(const nlohmann::json& result, Journal& journal);
void forget_failures(Journal& journal);
std::size_t points_in(const Journal& journal);  // without repetitions

}  // namespace harness
