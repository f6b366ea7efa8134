#include "harness/cli/sweep_command.h"

#include <filesystem>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/paths.h"
#include "harness/points/identity.h"

namespace harness {
namespace {

bool exists(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

}  // namespace

std::string chosen_output(const SweepCommand& options, const std::string& stem) {
  if (!options.out.empty()) return regular_output_path(options.out);
  const auto numbered = [&stem](int i) {
    return local_result(stem + (i == 1 ? "" : "-" + std::to_string(i)) + ".json");
  };
  int free = 1;
  while (exists(numbered(free))) ++free;
  const bool last = options.resume || options.rerun_failed || options.force;
  if (last && free > 1 && !exists(numbered(free) + ".journal")) --free;
  return numbered(free);
}

void check_unfinished(const SweepCommand& options, const Unfinished& found) {
  const bool again = options.resume || options.rerun_failed;
  const std::string entries = std::to_string(found.entries) + " " + found.what;
  if (options.force) return;
  if (!found.damage.empty())
    throw UsageError("'" + found.path + "' is damaged, " + found.damage +
                     "; --resume --force goes on with the " + entries +
                     " that it still holds, --force starts anew");
  if (found.entries > 0 && !again)
    throw UsageError(
        "'" + found.path + "' holds " + entries +
        " of a run that did not finish: --resume goes on with it, --force starts anew");
}

void check_unwritten(const SweepCommand& options, const std::string& out) {
  if (!options.force && !options.resume && !options.rerun_failed && exists(out))
    throw UsageError("'" + out +
                     "' is there already: --force replaces it, --resume completes it, and another "
                     "--out keeps both");
}

void check_same(const SweepCommand& options, const std::string& path, const nlohmann::json& was,
                const nlohmann::json& mine) {
  if (was.is_null() || options.force) return;
  const std::string what = difference(was, mine);
  if (!what.empty())
    throw UsageError("'" + path + "' is of another build or selection: " + what +
                     "; --resume --force goes on all the same");
}

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
  only(!options.scene_words.parameters.empty(), "--set", others);
  only(!options.scene_words.pins.empty(), "--pins", others);
  only(!options.scene_words.body.empty(), "--collider", others);
  only(!options.n.empty(), "--n", others);
  only(!options.limits.empty(), "--limit", others);
  only(!options.filter.empty(), "--filter", std::string(others) + " (--case chooses hard cases)");
  only(!options.exclude.empty(), "--exclude", others);
  only(!options.config.empty(), "--config", others);
  only(!options.reps.empty(), "--reps", others);
  only(options.rel_ci > 0, "--rel-ci", others);
  only(options.timeout > 0, "--timeout", others);
  only(options.step != "search", "--step", others);
  only(options.finest > 0, "--finest", others);
  only(options.finest_error > 0, "--finest-error", others);
  only(options.untimed, "--untimed", others);
  only(options.memory > 0, "--memory", others);
  only(options.rerun_failed, "--rerun-failed", others);
  only(options.in_process, "--in-process", others);
}

}  // namespace harness
