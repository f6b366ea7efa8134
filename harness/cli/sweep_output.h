// Where a result goes, and what may be there already.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace harness {

struct OutputOptions {
  std::string out;
  bool resume = false, rerun_failed = false, force = false;
};

// Where the result goes: to --out, a regular file, or to results/local/<stem>.json; or, where that
// has a finished result, to <stem>-2.json and so on, unless it is that one which is meant
// (--resume, --rerun-failed, --force). Throws UsageError.
std::string chosen_output(const OutputOptions& options, const std::string& stem);

// The journal of a run that did not finish.
struct Unfinished {
  std::string path, damage;  // damage: "" if nothing is wrong with it
  std::size_t entries = 0;
  std::string what;  // entries are, "points"
};
// Whether it may be taken up or dropped: throws UsageError, with the options that say so, if none
// of them is given.
void check_unfinished(const OutputOptions& options, const Unfinished& found);
// The same of a finished result.
void check_unwritten(const OutputOptions& options, const std::string& out);
// Throws UsageError unless what `path` holds, of the identity `was` (null: nothing), is of this
// build and selection, or --force takes it all the same.
void check_same(const OutputOptions& options, const std::string& path, const nlohmann::json& was,
                const nlohmann::json& mine);

}  // namespace harness
