// bench compare: two results point by point.
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/json_text.h"
#include "harness/base/paths.h"
#include "harness/cli/compare_options.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/verbs.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

struct CompareCommand : CompareOptions {
  std::string base;
  std::vector<std::string> next;
};

std::string with_spaces(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

int run_compare(const CompareCommand& options) {
  const Gate gate =
      read_gate(options.gate.empty() ? source_path("configs/gate.json") : options.gate);
  const ComparedResult base = read_compared({options.base});
  const ComparedResult next = read_compared(options.next);
  check_reports(options);
  try {
    const Comparison comparison = compare(base, next, gate);
    return report_comparison(
        comparison, options, "bench compare",
        "times of best points differ, but too few runs or too noisy a machine leave open whether "
        "that is noise: take more --reps, or use bench ab, which times in pairs");
  } catch (const NotComparable& reason) {
    std::cerr << "bench: " << reason.what() << "; a new baseline: bench baseline "
              << with_spaces(options.next) << " --out "
              << (base.baseline ? options.base : "baseline.json") << '\n';
    return not_comparable;
  }
}

}  // namespace

Verb compare_verb() {
  return {"compare",
          "compare two results point by point: what is slower, less accurate or fails now",
          [](const Command& command) -> Action {
            const auto given = std::make_shared<CompareCommand>();
            command.option("base", given->base, "result file or baseline", "BASE.json").required();
            command.option("new", given->next, "result files; several count as one", "NEW.json")
                .required();
            add_compare_options(command, *given);
            return [given] { return run_compare(*given); };
          }};
}

}  // namespace harness
