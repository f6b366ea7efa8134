// bench compare, baseline: two results point by point, and a result for the next comparisons.

#include "harness/cli/command.h"

namespace harness {

void CompareOptions::declare(const Command& to) {
  to.option("--gate", gate, "what passes; default: configs/gate.json", "FILE");
  to.option("--junit", junit, "also write JUnit XML, one test case a point", "FILE");
  to.option("--markdown", markdown, "also write the table in Markdown", "FILE");
}

void CompareOptions::check_reports() const {
  for (const std::string& path : {junit, markdown}) {
    if (!path.empty()) check_writable(path);
  }
}

int CompareOptions::report(const Comparison& comparison, const std::string& name,
                           const std::string& undecided) const {
  if (!junit.empty()) write_atomically(junit, junit_xml(comparison, name));
  if (!markdown.empty()) write_atomically(markdown, markdown_table(comparison, name));
  print_comparison(std::cout, comparison);
  if (comparison.any(is_failure)) return unexpected_outcome;
  if (comparison.any(is_regression)) return regression;
  if (!comparison.undecided()) return success;
  std::cerr << "bench: " << undecided << '\n';
  return cannot_decide;
}

namespace {

struct Compare : CompareOptions {
  std::string base;
  Words next;

  void declare(const Command& command) {
    command.option("base", base, "result file or baseline", "BASE.json");
    command.option("new", next, "result files; several count as one", "NEW.json");
    command.require({"base", "new"});
    CompareOptions::declare(command);
  }

  int run() {
    const Gate passes = read_gate(gate.empty() ? source_path("configs/gate.json") : gate);
    const ComparedResult before = read_compared({base}), after = read_compared(next);
    check_reports();
    try {
      return report(compare(before, after, passes), "bench compare",
                    "times of best points differ, but too few runs or too noisy a machine leave "
                    "open whether that is noise: take more --reps, or use bench ab, which times in "
                    "pairs");
    } catch (const NotComparable& reason) {
      std::string hint = "; a new baseline: bench baseline";
      for (const std::string& file : next) hint += " " + file;
      throw NotComparable(reason.what() + hint + " --out " +
                          (before.baseline ? base : "baseline.json"));
    }
  }
};

struct Baseline {
  Words files;
  std::string out;

  void declare(const Command& command) {
    add_results(command, files, "result files");
    command.option("--out", out, "the baseline", "FILE");
    command.require({"--out"});
  }

  int run() {
    const ComparedResult result = read_compared(files);
    if (result.baseline)
      throw UsageError("'" + result.path + "' is not a result file, of which a baseline is made");
    if (!result.complete)
      throw UsageError("'" + result.path + "' is of an interrupted run: no baseline");
    check_writable(out);
    write_atomically(out, document_text(baseline_document(result)));
    std::cout << out << ": " << result.points.size() << " points" << std::endl;
    return success;
  }
};

}  // namespace

Action compare_verb(const Command& command) { return verb<Compare>(command); }
Action baseline_verb(const Command& command) { return verb<Baseline>(command); }

}  // namespace harness
