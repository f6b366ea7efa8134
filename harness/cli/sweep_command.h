// What `bench --sweep AXIS` was asked for, and the two commands that are behind it.
#pragma once

#include <nlohmann/json.hpp>

#include "harness/cli/sweep_options.h"

namespace harness {

struct SweepCommand : SweepOptions {
  std::string out, shard;
  double memory = 0;  // bytes; 0: no limit
  bool resume = false, rerun_failed = false, force = false, in_process = false;
  bool dry_run = false, no_plots = false, no_wait = false;
  // of --sweep stability
  std::string hard_case;
  std::vector<std::string> values;
};

// Where the result goes: to --out, a regular file, or to results/local/<stem>.json; or, where that
// has a finished result, to <stem>-2.json and so on, unless it is that one which is meant
// (--resume, --rerun-failed, --force). Throws UsageError.
std::string chosen_output(const SweepCommand& options, const std::string& stem);

// The journal of a run that did not finish.
struct Unfinished {
  std::string path, damage;  // damage: "" if nothing is wrong with it
  std::size_t entries = 0;
  std::string what;  // entries are, "points"
};
// Whether it may be taken up or dropped: throws UsageError, with the options that say so, if none
// of them is given.
void check_unfinished(const SweepCommand& options, const Unfinished& found);
// The same of a finished result.
void check_unwritten(const SweepCommand& options, const std::string& out);
// Throws UsageError unless what `path` holds, of the identity `was` (null: nothing), is of this
// build and selection, or --force takes it all the same.
void check_same(const SweepCommand& options, const std::string& path, const nlohmann::json& was,
                const nlohmann::json& mine);

// Options of --sweep stability that the others do not have, and the other way round: an option that
// would do nothing is an error. Throws UsageError.
void check_options(const SweepCommand& options);

// command: the words of the command line, for the record. Both return an ExitCode.
int sweep_command(const SweepCommand& options, const std::vector<std::string>& command);
// Its cases are in the program, not in a suite.
int stability_command(const SweepCommand& options, const std::vector<std::string>& command);

}  // namespace harness
