#include "harness/cli/compare_options.h"

#include <iostream>

#include "harness/base/files.h"
#include "harness/cli/exit_codes.h"
#include "harness/compare/comparison.h"

namespace harness {

void add_compare_options(const Command& to, CompareOptions& options) {
  to.option("--gate", options.gate, "what passes; default: configs/gate.json", "FILE");
  to.option("--junit", options.junit, "also write JUnit XML, one test case a point", "FILE");
  to.option("--markdown", options.markdown, "also write the table in Markdown", "FILE");
}

void check_reports(const CompareOptions& options) {
  for (const std::string& path : {options.junit, options.markdown}) {
    if (!path.empty()) check_writable(path);
  }
}

int report_comparison(const Comparison& comparison, const CompareOptions& options,
                      const std::string& name, const std::string& undecided) {
  if (!options.junit.empty()) write_atomically(options.junit, junit_xml(comparison, name));
  if (!options.markdown.empty())
    write_atomically(options.markdown, markdown_table(comparison, name));
  print_comparison(std::cout, comparison);
  if (comparison.any(is_failure)) return unexpected_outcome;
  if (comparison.any(is_regression)) return regression;
  if (!comparison.undecided()) return success;
  std::cerr << "bench: " << undecided << '\n';
  return cannot_decide;
}

}  // namespace harness
