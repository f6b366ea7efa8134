// What `bench --sweep AXIS` was asked for, and the two commands that are behind it.
#pragma once

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

// command: the words of the command line, for the record. Both return an ExitCode.
int sweep_command(const SweepCommand& options, const std::vector<std::string>& command);
// Its cases are in the program, not in a suite.
int stability_command(const SweepCommand& options, const std::vector<std::string>& command);

}  // namespace harness
