// What solvers make of figures that theory knows.
#include <algorithm>
#include <cmath>
#include <map>

#include "harness/base/fields_json.h"
#include "harness/base/text.h"
#include "harness/claims/page.h"

namespace harness::claims {

using nlohmann::json;

namespace {

// What came of one answer: a row for each solver, a column for each step.
struct AnswerTable {
  std::vector<std::string> solvers;
  std::vector<double> steps;
  std::map<std::pair<std::string, double>, const json*> rows;

  AnswerTable(const json& document, const std::string& answer) {
    for (const json& row : document.at("rows")) {
      if (row.at("answer") != answer) continue;
      const std::string solver = row.at("solver");
      const double step = row.at("step");
      if (std::find(solvers.begin(), solvers.end(), solver) == solvers.end())
        solvers.push_back(solver);
      if (std::find(steps.begin(), steps.end(), step) == steps.end()) steps.push_back(step);
      rows[{solver, step}] = &row;
    }
  }

  std::vector<std::string> cells(const std::string& solver, double exact) const {
    std::vector<std::string> cells{quoted(solver)};
    double order = std::nan("");
    for (const double step : steps) {
      const auto found = rows.find({solver, step});
      if (found == rows.end()) {
        cells.emplace_back("-");
        continue;
      }
      const json& row = *found->second;
      const double value = number_of(row.at("value"));
      cells.push_back(std::isfinite(value) ? plain(value, exact == 0 ? 2 : 4) : "-");
      order = number_of(row.at("order"));
    }
    cells.push_back(std::isfinite(order) ? number_text(order, 2) : "-");
    return cells;
  }
};

// As a sentence begins.
std::string capitalized(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] -= 'a' - 'A';
  return text;
}

}  // namespace

void print_answers(std::ostream& out, const NamedResult& result) {
  out << "## Known answers (`" << result.name
      << "`)\n\nScenes whose answer theory gives, by each solver at its default settings and at "
         "steps of half the size from column to column. Order: that of the last two steps, of the "
         "deviation from the exact value; where the answer is that of a continuum, of the "
         "change from step to step. A dash: the solver refused, or took too long.\n\n";
  for (const json& answer : result.document.at("answers")) {
    const double exact = answer.at("exact");
    out << "### " << answer.at("name").get<std::string>() << ", scene `"
        << answer.at("scene").get<std::string>() << "`\n\n"
        << capitalized(answer.at("quantity")) << ". Exact: " << number_text(exact, 6)
        << (answer.at("continuum").get<bool>() ? ", for ever more vertices" : "") << ". "
        << capitalized(answer.at("source")) << ". Permitted strain "
        << number_text(100 * answer.at("strain_limit").get<double>(), 2) << " %.\n\n";
    const AnswerTable table(result.document, answer.at("name"));
    std::vector<std::string> head{"solver"};
    for (const double step : table.steps) head.push_back("at " + step_text(step) + " s");
    head.emplace_back("order");
    print_head(out, head);
    for (const std::string& solver : table.solvers) print_row(out, table.cells(solver, exact));
    out << '\n';
  }
}

}  // namespace harness::claims
