// What result files say: bench show, budget and claims.
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <string_view>

#include "harness/analysis/analysis_json.h"
#include "harness/analysis/budget.h"
#include "harness/answers/answer.h"
#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/standard_streams.h"
#include "harness/base/text.h"
#include "harness/claims/claims.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/options.h"
#include "harness/cli/output.h"
#include "harness/cli/verbs.h"
#include "harness/points/result_file.h"
#include "harness/tables/results_page.h"
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

}  // namespace

void print_sweep_result(std::ostream& out, const json& document, const std::string& file,
                        bool all) {
  const json& context = document.at("context");
  print_sweep(out, document, all, output_columns());
  if (const json share = context.value("harness_overhead", json::object()); share.contains("of")) {
    const double own = share.at("seconds_per_step"), step = share.at("shortest_step");
    out << "\nthe harness's own share of the shortest timed step: " << number_text(1e9 * own, 2)
        << " ns of " << number_text(1e9 * step, 3) << " ns, " << number_text(100 * own / step, 2)
        << " % (" << share.at("of").get<std::string>() << ")\n";
  }
  if (const auto pair = noise_of(context))
    out << "\n"
        << pair->one << " ran twice under two names: in 95 % of " << pair->places
        << " places its two times are within " << number_text(100 * std::expm1(pair->q95), 2)
        << " % of each other; smaller differences between solvers are noise\n";
  if (document.contains("warning"))
    out << "\n" << document.at("warning").get<std::string>() << '\n';
  if (const json kernel = context.value("sentinel", json::object()); kernel.value("noisy", false))
    out << "\nNOISY: a fixed kernel's time varied by "
        << number_text(100 * kernel.value("spread", 0.0), 2)
        << " % during the run; counters and errors are valid, compare times with care\n";
  if (!all)
    out << "\nall contestants: bench show " << file << " --all; a page with figures: bench report "
        << file << " --out report.html\n";
}

namespace {

void print_whole(std::ostream& out, const json& document, const std::string& file, bool all) {
  print_head(out, document, file);
  if (is_answers(document)) return print_answers(out, document);
  if (document.contains("matrix")) return print_outcomes(out, document);
  print_sweep_result(out, document, file, all);
}

bool is_sweep(const json& document) { return document.at("schema") == "inextensible-bench/1"; }

struct Show {
  Words files;
  bool as_json = false, all = false;

  void declare(const Command& command) {
    add_results(command, files, "result files; several count as one");
    command.flag("--json", as_json,
                 "as JSON: which contestant is fastest within each strain limit and error");
    command.flag("--all", all, "every contestant, and how runs failed");
  }

  int run() {
    if (as_json && all) throw UsageError("--json has all contestants already: leave out --all");
    // Several files are one table; a file of known answers is printed by itself.
    const json document =
        files.size() == 1 ? read_result(files.front(), ResultKinds::all) : read_results(files);
    if (!as_json) {
      std::ostringstream text;
      print_whole(text, document, files.front(), all);
      std::cout << fitted(text.str(), output_columns());
    } else if (is_sweep(document)) {
      std::cout << analysis::analysis_of(document).dump(1) << '\n';
    } else {
      throw UsageError("'" + files.front() +
                       "' has no strain limits and errors to be analyzed; --json is for sweeps "
                       "over strain, resolution and step");
    }
    return success;
  }
};

struct Budget {
  Words files;
  std::string ms = "1,4,16";

  void declare(const Command& command) {
    add_results(command, files, "result files");
    command.option("--ms", ms, "milliseconds of one core for a frame of 1/60 s; default: " + ms,
                   "MS,...");
  }

  int run() {
    std::vector<double> seconds = numbers_of("--ms", ms, Bounds::positive());
    for (double& budget : seconds) budget *= 1e-3;
    std::vector<json> sweeps;
    for (const std::string& file : files) {
      if (json document = read_result(file, ResultKinds::all); is_sweep(document))
        sweeps.push_back(std::move(document));
    }
    std::vector<analysis::BudgetTable> tables;
    const json table = sweeps.empty() ? json() : joined(sweeps);  // the tables refer to it
    if (!sweeps.empty()) tables = analysis::budget_tables(table, seconds);
    if (tables.empty())
      throw UsageError("'" + files.front() +
                       "' has no times of frames; sweeps of at least one second have them");
    print_budgets(std::cout, tables);
    return success;
  }
};

struct Claims {
  Words files;
  std::string markdown;

  void declare(const Command& command) {
    add_results(command, files, "result files");
    command.option("--markdown", markdown, "also write the table in Markdown", "FILE");
  }

  int run() {
    if (!markdown.empty()) check_writable(markdown);
    std::vector<json> results;
    for (const std::string& file : files) {
      if (json document = read_result(file, ResultKinds::all); !is_answers(document))
        results.push_back(std::move(document));  // no claim is about answers
    }
    if (results.empty()) throw UsageError("claims are about sweeps; results/*.json has some");
    const std::vector<ClaimVerdict> verdicts = judge_claims(results);
    if (std::all_of(verdicts.begin(), verdicts.end(), [](const ClaimVerdict& claim) {
          return claim.verdict == std::string_view(claims::not_measured);
        }))
      throw UsageError("nothing in '" + files.front() +
                       "' is what a claim is about; results/*.json are");
    if (!markdown.empty()) {
      std::ostringstream table;
      print_claims_markdown(table, verdicts);
      write_atomically(markdown, table.str());
    }
    print_claims(std::cout, verdicts);
    return success;
  }
};

}  // namespace

Verb show_verb() {
  return {"show", "print a result file: which method is fastest within each strain limit and error",
          verb<Show>};
}

Verb budget_verb() {
  return {"budget", "strain and error of each method within a frame budget", verb<Budget>};
}

Verb claims_verb() {
  return {"claims", "decide the paper's claims from result files", verb<Claims>};
}

}  // namespace harness
