// bench budget: strain and error of each method within a frame budget.
#include <iostream>

#include "harness/analysis/budget.h"
#include "harness/base/errors.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/shared_options.h"
#include "harness/cli/verbs.h"
#include "harness/points/joined.h"
#include "harness/points/result_file.h"
#include "harness/tables/results_page.h"

namespace harness {
namespace {

int print_budgets_of(const std::vector<std::string>& files, const std::vector<double>& ms) {
  std::vector<nlohmann::json> sweeps;
  for (const std::string& file : files) {
    nlohmann::json document = read_result_or_answers(file);
    if (document.at("schema") == "inextensible-bench/1") sweeps.push_back(std::move(document));
  }
  std::vector<double> seconds;
  seconds.reserve(ms.size());
  for (const double budget : ms) seconds.push_back(1e-3 * budget);
  const nlohmann::json table = sweeps.empty() ? nlohmann::json() : joined(sweeps);
  const auto tables = sweeps.empty() ? std::vector<analysis::BudgetTable>()
                                     : analysis::budget_tables(table, seconds);
  if (tables.empty())
    throw UsageError("'" + files.front() +
                     "' has no times of frames; sweeps of at least one second have them");
  print_budgets(std::cout, tables);
  return success;
}

}  // namespace

Verb budget_verb() {
  return {
      "budget", "strain and error of each method within a frame budget",
      [](const Command& command) -> Action {
        struct Given {
          std::vector<std::string> files;
          std::string ms = "1,4,16";
        };
        const auto given = std::make_shared<Given>();
        command.option("results", given->files, "result files", "RESULT.json").required();
        command.option("--ms", given->ms,
                       "milliseconds of one core for a frame of 1/60 s; default: 1,4,16", "MS,...");
        return [given] {
          return print_budgets_of(given->files, numbers_of("--ms", given->ms, Bounds::positive()));
        };
      }};
}

}  // namespace harness
