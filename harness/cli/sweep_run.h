// What `bench --sweep AXIS` was asked for, and the two kinds of runs that are behind it.
#pragma once

#include "harness/cli/sweep_options.h"
#include "harness/cli/sweep_output.h"

namespace harness {

struct SweepCommand : SweepOptions, OutputOptions {
  std::string shard;
  double memory = 0;  // bytes; 0: no limit
  bool in_process = false, dry_run = false, no_plots = false, no_wait = false;
  // of --sweep stability
  std::string hard_case;
  std::vector<std::string> values;
};

// command: the words of the command line, for the record. Both return an ExitCode.
int run_suite(const SweepCommand& options, const std::vector<std::string>& command);
// The cases are in the program, not in a suite.
int run_hard_cases(const SweepCommand& options, const std::vector<std::string>& command);

}  // namespace harness
