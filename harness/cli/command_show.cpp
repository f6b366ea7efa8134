// bench show: what a result file says, as the sweep said it at its end.
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <set>

#include "harness/analysis/analysis_json.h"
#include "harness/answers/measure.h"
#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/verbs.h"
#include "harness/points/noise.h"
#include "harness/points/result_file.h"
#include "harness/tables/terminal.h"

namespace harness {
namespace {

using nlohmann::json;

void print_head(const json& document, const std::string& file) {
  const json& context = document.at("context");
  const json& build = context.at("build");
  std::cout << file << ": " << context.at("date").get<std::string>() << " on "
            << context.at("cpu_model").get<std::string>() << ", commit "
            << build.at("git").get<std::string>().substr(0, 12)
            << (build.value("dirty", false) ? " with changes" : "") << ", "
            << build.at("compiler").get<std::string>() << '\n';
  if (document.contains("warning")) std::cout << document.at("warning").get<std::string>() << '\n';
  if (!document.value("complete", true)) std::cout << "not complete: the run was interrupted\n";
  if (!is_timed(document)) std::cout << "made with --untimed: its times mean nothing\n";
}

// How each solver's hard cases ended, and which did not end as expected.
void print_outcomes(const json& document) {
  std::map<std::string, std::map<std::string, int>> counts;
  std::set<std::string> outcomes;
  for (const json& cell : document.at("matrix")) {
    const std::string outcome = cell.at("outcome");
    ++counts[cell.at("solver").get<std::string>()][outcome];
    outcomes.insert(outcome);
  }
  constexpr int name_width = 32, width = 18;
  std::cout << document.at("matrix").size() << " hard cases and solvers; how they ended:\n"
            << std::left << std::setw(name_width) << "";
  for (const std::string& outcome : outcomes) std::cout << std::setw(width) << outcome;
  std::cout << '\n';
  for (auto& [solver, ended] : counts) {
    std::cout << std::setw(name_width) << solver;
    for (const std::string& outcome : outcomes) std::cout << std::setw(width) << ended[outcome];
    std::cout << '\n';
  }
  for (const json& cell : document.at("matrix")) {
    if (cell.at("as_expected").get<bool>()) continue;
    std::cout << "not as expected"
              << (cell.at("known_difference").get<bool>() ? ", but known: " : ": ")
              << cell.at("case").get<std::string>() << ", " << cell.at("solver").get<std::string>()
              << ": " << cell.at("outcome").get<std::string>() << '\n';
  }
}

int show(const std::string& file, bool all) {
  const json document = read_result_or_answers(file);
  print_head(document, file);
  if (is_answers(document)) {
    print_answers(std::cout, document);
    return success;
  }
  if (document.at("schema") == "inextensible-stability/1") {
    print_outcomes(document);
    return success;
  }
  const json& context = document.at("context");
  print_sweep(std::cout, document, all);
  if (const auto pair = noise_of(context))
    std::cout << "\ndifferences below " << number_text(100 * std::expm1(pair->q95), 2)
              << " % are noise, by " << pair->one << " against itself\n";
  if (!all)
    std::cout << "\nall contestants: bench show " << file
              << " --all; a page with figures: bench report " << file << " --out report.html\n";
  return success;
}

// The analysis of the sweep's points, for programs.
int show_json(const std::string& file) {
  const json document = read_result_or_answers(file);
  if (document.at("schema") != "inextensible-bench/1")
    throw UsageError("'" + file +
                     "' has no strain limits and errors to be analyzed; --json is for "
                     "sweeps over strain, resolution and step");
  std::cout << analysis::analysis_of(document).dump(1) << '\n';
  return success;
}

}  // namespace

Verb show_verb() {
  return {"show", "print a result file: which method is fastest within each strain limit and error",
          [](const Command& command) -> Action {
            struct Given {
              std::string file;
              bool as_json = false, all = false;
            };
            const auto given = std::make_shared<Given>();
            command.option("result", given->file, "result file", "RESULT.json").required();
            command.flag("--json", given->as_json,
                         "as JSON: which contestant is fastest within each strain limit and error");
            command.flag("--all", given->all, "every contestant, and how runs failed");
            return [given] {
              if (given->as_json && given->all)
                throw UsageError("--json has all contestants already: leave out --all");
              return given->as_json ? show_json(given->file) : show(given->file, given->all);
            };
          }};
}

}  // namespace harness
