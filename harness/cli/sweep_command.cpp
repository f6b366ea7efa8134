#include "harness/cli/sweep_command.h"

#include <filesystem>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/paths.h"

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
  only(options.max_error > 0, "--max-error", others);
  only(options.untimed, "--untimed", others);
  only(options.memory > 0, "--memory", others);
  only(options.rerun_failed, "--rerun-failed", others);
  only(options.in_process, "--in-process", others);
  only(!options.shard.empty(), "--shard", others);
}

}  // namespace harness
