#include "harness/cli/sweep_output.h"

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

std::string chosen_output(const OutputOptions& options, const std::string& stem) {
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

void check_unfinished(const OutputOptions& options, const Unfinished& found) {
  const bool again = options.resume || options.rerun_failed;
  const std::string entries = std::to_string(found.entries) + " " + found.what;
  if (options.force) return;
  if (!found.damage.empty())
    throw UsageError("'" + found.path + "' is damaged, " + found.damage +
                     "; --resume --force continues with the " + entries +
                     " that can be read, --force starts again");
  if (found.entries > 0 && !again)
    throw UsageError("'" + found.path + "' has " + entries +
                     " of a run that did not finish: --resume continues it, --force starts again");
}

void check_unwritten(const OutputOptions& options, const std::string& out) {
  if (!options.force && !options.resume && !options.rerun_failed && exists(out))
    throw UsageError("'" + out +
                     "' exists: --force replaces it, --resume completes it, and another "
                     "--out keeps both");
}

void check_same(const OutputOptions& options, const std::string& path, const nlohmann::json& was,
                const nlohmann::json& mine) {
  if (was.is_null() || options.force) return;
  const std::string what = difference(was, mine);
  if (!what.empty())
    throw UsageError("'" + path + "' is of another build or selection: " + what +
                     "; --resume --force continues nevertheless");
}

}  // namespace harness
