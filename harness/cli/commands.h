// The program's commands, one file each (command_*.cpp). A command adds its options to the command
// line and, when it is chosen there, puts what it does into `chosen`; main() runs that.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace harness {

enum ExitCode {
  success = 0,
  internal_error = 1,
  usage_error = 2,
  regression = 3,
  unexpected_outcome = 4,
  not_comparable = 5,
  skipped = 77,
  interrupted_exit = 130
};

using Chosen = std::function<int()>;  // returns an ExitCode; throws UsageError

void add_sweep_command(CLI::App& app, Chosen& chosen, const std::vector<std::string>& command);
void add_reference_command(CLI::App& app, Chosen& chosen);
void add_list_command(CLI::App& app, Chosen& chosen);
void add_claims_command(CLI::App& app, Chosen& chosen);
void add_results_command(CLI::App& app, Chosen& chosen);
void add_merge_command(CLI::App& app, Chosen& chosen);
void add_plot_command(CLI::App& app, Chosen& chosen);
void add_emit_command(CLI::App& app, Chosen& chosen);
void add_check_command(CLI::App& app, Chosen& chosen);
void add_compare_command(CLI::App& app, Chosen& chosen);
void add_baseline_command(CLI::App& app, Chosen& chosen);
void add_point_command(CLI::App& app, Chosen& chosen);
void add_ab_command(CLI::App& app, Chosen& chosen);
void add_history_command(CLI::App& app, Chosen& chosen);

// Runs a script of plots/ on result files; its paths go to stdout as they are. Its exit code.
int draw(const std::vector<std::string>& arguments, const std::string& script = "figures.py");

}  // namespace harness
