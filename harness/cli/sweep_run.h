// What `bench --sweep AXIS` was asked for, and hard cases, which are run otherwise than suites.
#pragma once

#include "harness/cli/options.h"
#include "harness/cli/output.h"

namespace harness {

struct SweepCommand : SweepOptions, OutputOptions {
  std::string shard;
  double memory = 0;  // bytes; 0: no limit
  bool in_process = false, dry_run = false, no_wait = false;
  // of --sweep stability
  std::string hard_case;
  Words values;

  void declare(const Command& command);
  int run(const Words& typed);

 private:
  Command of_suites_, of_cases_;  // options that only one kind of sweep has
};

// The cases are in the program, not in a suite. typed: the words of the command line, for the
// record. An ExitCode.
int run_hard_cases(const SweepCommand& options, const Words& typed);

}  // namespace harness
