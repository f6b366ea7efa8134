// bench emit: the script that runs a sweep in shards under Slurm or GNU parallel.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/paths.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/sweep_options.h"
#include "harness/cli/verbs.h"
#include "harness/run/job_script.h"

namespace harness {
namespace {

struct EmitCommand : SweepOptions {
  std::string scheduler;
  JobScript job;
};

// All solvers of one scene and size stay in one shard, so that there may be less work than shards.
std::size_t shares(const std::vector<Search>& searches, std::size_t shards) {
  std::size_t filled = 0;
  for (std::size_t i = 1; i <= shards; ++i) filled += !shard(searches, {i, shards}).empty();
  return filled;
}

// What the sweep itself would refuse is refused here, before anything waits in a queue.
void check_sweep(const Suite& suite, const EmitCommand& given) {
  const auto searches = plan(suite, make_filters(given));
  const std::size_t shards = given.job.shards;
  const std::size_t most = shares(searches, shards);
  if (shards > most)
    throw UsageError("--shards " + std::to_string(shards) + ": this sweep has " +
                     std::to_string(most) +
                     " scenes and sizes to share out, each of which stays in one shard");
  ReferenceShelf shelf(source_path("results/references"));
  if (given.finest_error > 0 && !without_reference(searches, shelf).empty())
    throw UsageError(
        "--finest-error needs references, some are missing (bench reference, with the same scene "
        "and "
        "profile, makes them)");
  if (std::filesystem::is_directory(given.job.result))
    throw UsageError("--out '" + given.job.result + "' is a folder, must be the result's name");
}

int emit(EmitCommand& given) {
  const std::vector<std::string> known{"slurm", "parallel"};
  if (std::find(known.begin(), known.end(), given.scheduler) == known.end())
    throw unknown_name("batch system", given.scheduler, known);
  const bool slurm = given.scheduler == "slurm";
  JobScript& job = given.job;
  if (!slurm && !(job.time + job.partition + job.account).empty())
    throw UsageError("--time, --partition and --account go with emit slurm");
  if (slurm && job.jobs > 0) throw UsageError("--jobs goes with emit parallel");
  if (given.sweep == "stability")
    throw UsageError(
        "--sweep stability takes two minutes and has no job script; --shard cuts it by hand");
  if (!given.config.empty() && std::filesystem::exists(given.config) &&
      !std::filesystem::is_regular_file(given.config))
    throw UsageError("--config '" + given.config + "' will not be there when the shards are run");
  const Suite suite = load_suite(given);
  job.axis = given.sweep;
  job.jobs = std::max(1, job.jobs);
  if (job.result.empty()) job.result = "results/local/" + suite.name + "-" + given.sweep + ".json";
  const std::string text = (slurm ? slurm_script : parallel_script)(job);
  check_sweep(suite, given);
  std::cout << text << std::flush;
  return success;
}

}  // namespace

Verb emit_verb() {
  return {"emit", "print the script that runs a sweep in shards under Slurm or GNU parallel",
          [](const Command& command) -> Action {
            const auto given = std::make_shared<EmitCommand>();
            add_selection(command, *given);
            add_measurement(command, *given);
            const auto passed_on =
                command.as_typed();  // no number is rounded on its way through the script

            command.option("scheduler", given->scheduler, "slurm or parallel").required();
            JobScript& job = given->job;
            job.jobs = 0;  // not given
            command.option("--shards", job.shards, "parts of the sweep, each a job of its own", "N")
                .required()
                .within(1, 1000);
            command.option(
                "--out", job.result,
                "the merged result; default results/local/<profile>-<axis>.json. Shards and "
                "logs go to a folder of this name with -shards",
                "FILE");
            command.option("--memory", job.memory,
                           "that a point may have and a shard reserves, e.g. 4G", "SIZE");
            command.option("--time", job.time, "slurm: time limit of a shard", "HH:MM:SS");
            command.option("--partition", job.partition, "slurm: where to run", "NAME");
            command.option("--account", job.account, "slurm: whose hours", "NAME");
            command
                .option("--jobs", job.jobs, "parallel: shards at once (1; more disturb each other)",
                        "K")
                .within(1, 1000);
            return [given, passed_on] {
              given->job.sweep = passed_on();
              if (!given->job.memory.empty())
                given->job.sweep.push_back("--memory=" + given->job.memory);
              return emit(*given);
            };
          }};
}

}  // namespace harness
