// bench emit: a sweep in shards, as a script for an array of Slurm's or as commands for GNU
// parallel.
#include <algorithm>
#include <cctype>
#include <iostream>

#include "harness/base/errors.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/sweep_options.h"
#include "harness/cli/verbs.h"

namespace harness {
namespace {

struct EmitCommand : SweepOptions {
  std::string scheduler, result;
  int shards = 1;
  std::vector<std::string> sweep_words;  // bench's options
};

// The word as a shell reads it back, in quotes only where it needs them.
std::string shell_word(const std::string& word) {
  if (std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }))
    throw UsageError("a command of one line has no control characters: '" + word + "'");
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_./:=,@%+-").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// What the sweep itself would refuse is refused here, before anything waits in a queue. All solvers
// of one scene and size stay in one shard, so that there may be less work than shards.
void check_sweep(const Suite& suite, const EmitCommand& given) {
  const auto searches = plan(suite, make_filters(given));
  const auto shards = static_cast<std::size_t>(given.shards);
  std::size_t filled = 0;
  for (std::size_t i = 1; i <= shards; ++i) filled += !shard(searches, {i, shards}).empty();
  if (filled < shards)
    throw UsageError("--shards " + std::to_string(given.shards) + ": this sweep has " +
                     std::to_string(filled) +
                     " scenes and sizes to share out, each of which stays in one shard");
}

int emit(const EmitCommand& given) {
  const std::vector<std::string> known{"slurm", "parallel"};
  if (std::find(known.begin(), known.end(), given.scheduler) == known.end())
    throw unknown_name("batch system", given.scheduler, known);
  if (given.sweep == "stability")
    throw UsageError("--sweep stability is short and has no script; --shard divides it");
  const Suite suite = load_suite(given);
  check_sweep(suite, given);
  std::string result = given.result;
  if (result.empty()) result = "results/local/" + suite.name + "-" + given.sweep + ".json";
  const bool named = result.ends_with(".json");
  const std::string stem = named ? result.substr(0, result.size() - 5) : result;
  const std::string parts = shell_word(stem + "-shard-");
  const std::string shards = std::to_string(given.shards);
  const std::string end = "-of-" + shards + ".json";
  const std::string merge = "./bench merge " + parts + "*" + end + " --out " + shell_word(result);
  std::string words;
  for (const std::string& word : given.sweep_words) words += " " + shell_word(word);
  const auto command = [&](const std::string& number) {
    return "./bench" + words + " --no-plots --resume --shard " + number + "/" + shards + " --out " +
           parts + number + end + "\n";
  };
  if (given.scheduler == "parallel") {
    std::cout << "# To GNU parallel, then: " << merge << '\n';
    for (int i = 1; i <= given.shards; ++i) std::cout << command(std::to_string(i));
  } else {
    std::cout
        << "#!/usr/bin/env bash\n"
           "# sbatch THIS_FILE in the folder of bench, with --time, --partition, --constraint\n"
           "# and the like; the same once more goes on where shards were interrupted. Then:\n" +
               ("# " + merge + "\n#SBATCH --job-name=bench-" + given.sweep) +
               ("\n#SBATCH --array=1-" + shards + "\n") +
               "#SBATCH --exclusive\n"
               "#SBATCH --requeue\n"
               "#SBATCH --signal=B:TERM@60\n"  // bench then writes what it has
               "exec " +
               command("\"$SLURM_ARRAY_TASK_ID\"");
  }
  std::cout << std::flush;
  return success;
}

}  // namespace

Verb emit_verb() {
  return {
      "emit", "print a sweep in shards: a script for Slurm, or commands for GNU parallel",
      [](const Command& command) -> Action {
        const auto given = std::make_shared<EmitCommand>();
        add_selection(command, *given);
        add_measurement(command, *given);
        const auto passed_on = command.as_typed();  // no number is rounded on its way
        command.option("scheduler", given->scheduler, "slurm or parallel").required();
        command.option("--shards", given->shards, "parts of the sweep, each a job of its own", "N")
            .required()
            .within(1, 1000);
        command.option("--out", given->result,
                       "the merged result; default results/local/<profile>-<axis>.json", "FILE");
        return [given, passed_on] {
          given->sweep_words = passed_on();
          return emit(*given);
        };
      }};
}

}  // namespace harness
