// bench compare: two results point by point. bench baseline: a result for the next comparisons.
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/json_text.h"
#include "harness/base/paths.h"
#include "harness/cli/commands.h"
#include "harness/cli/compare_options.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

struct CompareCommand : CompareOptions {
  std::string base;
  std::vector<std::string> next;
};

std::string joined(const std::vector<std::string>& words) {
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
    return report_comparison(comparison, options, "bench compare");
  } catch (const NotComparable& reason) {
    std::cerr << "bench: " << reason.what() << "; a new baseline: bench baseline "
              << joined(options.next) << " --out "
              << (base.baseline ? options.base : "baseline.json") << '\n';
    return not_comparable;
  }
}

int make_baseline(const std::vector<std::string>& files, const std::string& out) {
  std::vector<nlohmann::json> results;
  results.reserve(files.size());
  for (const std::string& file : files) results.push_back(read_result(file));
  const ComparedResult checked = read_compared(files);  // all that a comparison will ask for
  if (checked.baseline) throw UsageError("a baseline is made from result files");
  if (!checked.complete)
    throw UsageError("'" + checked.path + "' is of an interrupted run: no baseline");
  check_writable(out);
  write_atomically(out, document_text(baseline_document(results)));
  std::cout << out << ": " << checked.points.size() << " points" << std::endl;
  return success;
}

}  // namespace

void add_compare_command(const Command& program) {
  const auto given = std::make_shared<CompareCommand>();
  const Command command = program.subcommand("compare",
                                             "two results point by point; exit 3 for a regression, "
                                             "4 for new failures, 5 if they cannot be "
                                             "compared, 6 if there are too few runs to tell");
  command.option("base", given->base, "result file or baseline", "BASE.json").required();
  command.option("new", given->next, "result files; several count as one", "NEW.json").required();
  add_compare_options(command, *given);
  command.does([given] { return run_compare(*given); });
}

void add_baseline_command(const Command& program) {
  struct Given {
    std::vector<std::string> files;
    std::string out;
  };
  const auto given = std::make_shared<Given>();
  const Command command = program.subcommand(
      "baseline", "results without times, one point a line, to be compared with later");
  command.option("results", given->files, "result files", "RESULT.json").required();
  command.option("--out", given->out, "the baseline", "FILE").required();
  command.does([given] { return make_baseline(given->files, given->out); });
}

}  // namespace harness
