// bench --sweep strain|resolution|step|stability.
#include "harness/base/errors.h"
#include "harness/cli/sweep_run.h"
#include "harness/cli/verbs.h"

namespace harness {
namespace {

// An option that would do nothing for this sweep is an error.
void check_options(const SweepCommand& options) {
  const bool stability = options.sweep == "stability";
  const auto only = [](bool given, const std::string& option, const std::string& sweeps) {
    if (given) throw UsageError(option + " goes with --sweep " + sweeps + " only");
  };
  if (!stability) {
    only(!options.hard_case.empty(), "--case", "stability");
    only(!options.values.empty(), "--values", "stability");
    return;
  }
  const char* others = "strain, resolution and step";
  only(!options.scene.empty(), "--scene", others);
  only(!options.parameters.empty(), "--set", others);
  only(!options.pins.empty(), "--pins", others);
  only(!options.body.empty(), "--collider", others);
  only(!options.n.empty(), "--n", others);
  only(!options.limits.empty(), "--limit", others);
  only(!options.filter.empty(), "--filter", std::string(others) + " (--case chooses hard cases)");
  only(!options.exclude.empty(), "--exclude", others);
  only(!options.config.empty(), "--config", others);
  only(!options.reps.empty(), "--reps", others);
  only(options.rel_ci > 0, "--rel-ci", others);
  only(options.timeout > 0, "--timeout", others);
  only(options.steps != "search", "--steps", others);
  only(options.finest > 0, "--finest", others);
  only(options.finest_error > 0, "--finest-error", others);
  only(options.untimed, "--untimed", others);
  only(options.memory > 0, "--memory", others);
  only(options.rerun_failed, "--rerun-failed", others);
  only(options.in_process, "--in-process", others);
}

}  // namespace

Verb sweep_verb() {
  return {
      "sweep", "time over strain limit, resolution or step, or hard cases: bench --sweep AXIS",
      [](const Command& command) -> Action {
        const auto given = std::make_shared<SweepCommand>();
        SweepCommand& options = *given;
        add_selection(command, options);
        command.option("--out", options.out,
                       "result file; default: results/local/<profile>-<axis>.json", "FILE");
        add_measurement(command, options);
        command.byte_count("--memory", options.memory, "address space a point may have, e.g. 4G");
        add_output_rules(command, options);
        command.flag("--rerun-failed", options.rerun_failed,
                     "as --resume, also after a finished run, and run again what failed");
        command.flag("--in-process", options.in_process,
                     "run points in this process, for debuggers and profilers");
        command.option("--shard", options.shard,
                       "i/N: the i-th of N parts; all solvers of a scene and size are in one part",
                       "I/N");
        command.option("--case", options.hard_case,
                       "stability: only cases whose name contains a match, e.g. 'Q[12]'", "REGEX");
        command.option(
            "--values", options.values,
            "stability: the values of a family of cases, e.g. ratios=1e3,1e5 (distances, "
            "limits, ratios, links, sides, scales)",
            "NAME=LIST");
        command.flag("--dry-run", options.dry_run, "print what would run and how long, and stop");
        add_no_wait(command, options.no_wait);
        add_no_plots(command, options.no_plots);
        return [given, command] {
          if (given->sweep.empty())
            throw UsageError(
                "nothing to do: give --sweep strain, resolution, step or stability (see bench "
                "--help)");
          check_options(*given);
          return given->sweep == "stability" ? run_hard_cases(*given, command.words())
                                             : run_suite(*given, command.words());
        };
      }};
}

}  // namespace harness
