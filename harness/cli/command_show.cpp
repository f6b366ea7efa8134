// bench show: what a result file says, as the sweep said it at its end.
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <set>
#include <sstream>

#include "harness/analysis/analysis_json.h"
#include "harness/answers/measure.h"
#include "harness/base/errors.h"
#include "harness/base/standard_streams.h"
#include "harness/base/text.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/verbs.h"
#include "harness/points/joined.h"
#include "harness/points/noise.h"
#include "harness/points/result_file.h"
#include "harness/tables/terminal.h"

namespace harness {
namespace {

using nlohmann::json;

void print_head(std::ostream& out, const json& document, const std::string& file) {
  const json& context = document.at("context");
  const json& build = context.at("build");
  out << file << ": " << context.at("date").get<std::string>() << " on "
      << context.at("cpu_model").get<std::string>() << ", commit "
      << build.at("git").get<std::string>().substr(0, 12)
      << (build.value("dirty", false) ? " with changes" : "") << ", "
      << build.at("compiler").get<std::string>() << '\n';
  if (document.contains("warning")) out << document.at("warning").get<std::string>() << '\n';
  if (!document.value("complete", true))
    out << "not complete: a run was interrupted, or a shard is missing\n";
  if (!is_timed(document)) out << "made with --untimed: its times mean nothing\n";
}

// How each solver's hard cases ended, and which did not end as expected.
void print_outcomes(std::ostream& out, const json& document) {
  std::map<std::string, std::map<std::string, int>> counts;
  std::set<std::string> outcomes;
  for (const json& cell : document.at("matrix")) {
    const std::string outcome = cell.at("outcome");
    ++counts[cell.at("solver").get<std::string>()][outcome];
    outcomes.insert(outcome);
  }
  constexpr int name_width = 32, width = 18;
  out << document.at("matrix").size() << " hard cases and solvers; how they ended:\n"
      << std::left << std::setw(name_width) << "";
  for (const std::string& outcome : outcomes) out << std::setw(width) << outcome;
  out << '\n';
  for (auto& [solver, ended] : counts) {
    out << std::setw(name_width) << solver;
    for (const std::string& outcome : outcomes) out << std::setw(width) << ended[outcome];
    out << '\n';
  }
  for (const json& cell : document.at("matrix")) {
    if (cell.at("as_expected").get<bool>()) continue;
    out << "not as expected" << (cell.at("known_difference").get<bool>() ? ", but known: " : ": ")
        << cell.at("case").get<std::string>() << ", " << cell.at("solver").get<std::string>()
        << ": " << cell.at("outcome").get<std::string>() << '\n';
  }
}

void print_whole(std::ostream& out, const json& document, const std::string& file, bool all) {
  print_head(out, document, file);
  if (is_answers(document)) {
    print_answers(out, document);
    return;
  }
  if (document.at("schema") == "inextensible-stability/1") {
    print_outcomes(out, document);
    return;
  }
  const json& context = document.at("context");
  print_sweep(out, document, all, output_columns());
  if (const auto pair = noise_of(context))
    out << "\ndifferences below " << number_text(100 * std::expm1(pair->q95), 2)
        << " % are noise, by " << pair->one << " against itself\n";
  if (!all)
    out << "\nall contestants: bench show " << file << " --all; a page with figures: bench report "
        << file << " --out report.html\n";
}

// Several files are one table; a file of known answers is printed by itself.
json read_shown(const std::vector<std::string>& files) {
  return files.size() == 1 ? read_result_or_answers(files.front()) : read_results(files);
}

int show(const std::vector<std::string>& files, bool all) {
  std::ostringstream text;
  print_whole(text, read_shown(files), files.front(), all);
  std::cout << fitted(text.str(), output_columns());
  return success;
}

// The analysis of the sweep's points, for programs.
int show_json(const std::vector<std::string>& files) {
  const json document = read_shown(files);
  if (document.at("schema") != "inextensible-bench/1")
    throw UsageError("'" + files.front() +
                     "' has no strain limits and errors to be analyzed; --json is for "
                     "sweeps over strain, resolution and step");
  std::cout << analysis::analysis_of(document).dump(1) << '\n';
  return success;
}

}  // namespace

Verb show_verb() {
  return {
      "show", "print a result file: which method is fastest within each strain limit and error",
      [](const Command& command) -> Action {
        struct Given {
          std::vector<std::string> files;
          bool as_json = false, all = false;
        };
        const auto given = std::make_shared<Given>();
        command.option("results", given->files, "result files; several count as one", "RESULT.json")
            .required();
        command.flag("--json", given->as_json,
                     "as JSON: which contestant is fastest within each strain limit and error");
        command.flag("--all", given->all, "every contestant, and how runs failed");
        return [given] {
          if (given->as_json && given->all)
            throw UsageError("--json has all contestants already: leave out --all");
          return given->as_json ? show_json(given->files) : show(given->files, given->all);
        };
      }};
}

}  // namespace harness
