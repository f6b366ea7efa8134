// The program's commands, one file each (command_*.cpp). Each adds itself, its options and what it
// does to the command line.
#pragma once

#include <string>
#include <vector>

#include "harness/cli/command_line.h"

namespace harness {

enum ExitCode {
  success = 0,
  internal_error = 1,
  usage_error = 2,
  regression = 3,
  unexpected_outcome = 4,
  not_comparable = 5,
  cannot_decide = 6,
  skipped = 77,
  interrupted_exit = 130
};

void add_sweep_command(const Command& program, const std::vector<std::string>& command);
void add_tune_command(const Command& program);
void add_reference_command(const Command& program);
void add_list_command(const Command& program);
void add_claims_command(const Command& program);
void add_film_command(const Command& program);
void add_results_command(const Command& program);
void add_answers_command(const Command& program, const std::vector<std::string>& command);
void add_merge_command(const Command& program);
void add_show_command(const Command& program);
void add_plot_command(const Command& program);
void add_report_command(const Command& program);
void add_emit_command(const Command& program);
void add_choose_command(const Command& program);
void add_check_command(const Command& program);
void add_compare_command(const Command& program);
void add_baseline_command(const Command& program);
void add_point_command(const Command& program);
void add_ab_command(const Command& program);

// Of commands that take times: do not wait for another that does so on this machine.
void add_no_wait(const Command& to, bool& no_wait);

// Runs a script of plots/ on result files; its paths go to stdout as they are. Its exit code.
int draw(const std::vector<std::string>& arguments, const std::string& script = "figures.py");
// The figures of a result file, with the analysis that they are drawn from. Throws UsageError for a
// file that is none.
int draw_result(const std::string& file, const std::vector<std::string>& more = {});
// Those of several files that are pieces of one sweep, drawn as one: their points together, the
// largest noise of any, all else from the first. name: what their pictures' names begin with.
int draw_pieces(const std::vector<std::string>& files, const std::string& name,
                const std::vector<std::string>& more);

}  // namespace harness
