// bench --sweep strain|resolution|step|stability.
#include "harness/base/errors.h"
#include "harness/cli/sweep_run.h"
#include "harness/cli/verbs.h"

namespace harness {

void SweepCommand::declare(const Command& command) {
  of_suites_ = command.group("with --sweep strain, resolution and step");
  of_cases_ = command.group("with --sweep stability");
  SweepOptions::declare(command, of_suites_);
  OutputOptions::declare(command, "<profile>-<axis>.json");
  command.option("--shard", shard,
                 "i/N: the i-th of N parts; all solvers of a scene and size are in one part",
                 "I/N");
  command.flag("--dry-run", dry_run, "print what would run and how long, and stop");
  add_no_wait(command, no_wait);
  of_suites_.byte_count("--memory", memory, "address space a point may have, e.g. 4G");
  of_suites_.flag("--rerun-failed", rerun_failed,
                  "as --resume, also after a finished run, and run again what failed");
  of_suites_.flag("--in-process", in_process,
                  "run points in this process, for debuggers and profilers");
  of_cases_.option("--case", hard_case, "only cases whose name contains a match, e.g. 'Q[12]'",
                   "REGEX");
  of_cases_.option("--values", values,
                   "the values of a family of cases, e.g. ratios=1e3,1e5 (distances, limits, "
                   "ratios, links, sides, scales)",
                   "NAME=LIST");
}

int SweepCommand::run(const Words& typed) {
  if (sweep.empty())
    throw UsageError(
        "nothing to do: give --sweep strain, resolution, step or stability (see bench --help)");
  const bool hard_cases = sweep == "stability";
  const Command& others = hard_cases ? of_suites_ : of_cases_;
  if (const std::string name = others.one_typed(); !name.empty())
    throw UsageError(name + " goes " + others.heading() + " only" +
                     (hard_cases ? " (--case chooses hard cases)" : ""));
  return hard_cases ? run_hard_cases(*this, typed) : run_suite(*this, typed);
}

Verb sweep_verb() {
  return {"sweep", "time over strain limit, resolution or step, or hard cases: bench --sweep AXIS",
          verb<SweepCommand>, true};
}

}  // namespace harness
