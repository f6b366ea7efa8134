// What the commands that compare have in common: a gate, and reports beside the table on stdout.
#pragma once

#include <string>

#include "harness/cli/command_line.h"
#include "harness/compare/comparison.h"

namespace harness {

struct CompareOptions {
  std::string gate, junit, markdown;

  void declare(const Command& to);
  // Throws UsageError for a report that cannot be written, before anything is done.
  void check_reports() const;
  // Prints the comparison, writes the reports; the exit code: a failure outranks a regression.
  // name: of the JUnit suite and the Markdown heading. undecided: what is said if times of best
  // points cannot be told apart.
  int report(const Comparison& comparison, const std::string& name,
             const std::string& undecided) const;
};

}  // namespace harness
