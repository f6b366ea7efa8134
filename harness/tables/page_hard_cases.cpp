#include <array>

#include "harness/tables/page.h"

namespace harness::tables {

using nlohmann::json;

namespace {

// What did not end as theory expects, with the reason where one is known.
void print_differences(std::ostream& out, const json& document) {
  std::vector<std::vector<std::string>> rows;
  for (const json& cell : document.at("matrix")) {
    if (cell.at("as_expected")) continue;
    std::string reason = "not known: " + cell.at("detail").get<std::string>();
    for (const json& known : document.at("known_differences")) {
      if (cell.at("known_difference") && known.at("case") == cell.at("case") &&
          known.at("solver") == cell.at("solver"))
        reason = known.at("reason").get<std::string>() +
                 "; would fix it: " + known.at("mends").get<std::string>();
    }
    const std::string fixed = cell.at("at_fixed_step"), outcome = cell.at("outcome");
    rows.push_back({quoted(cell.at("case")), quoted(cell.at("solver")),
                    cell.at("expected_at_fixed_step"),
                    fixed == outcome ? fixed : fixed + ", with smaller steps " + outcome, reason});
  }
  if (rows.empty()) return;
  print_head(out, {"case", "solver", "expected", "ended", "why"});
  for (const auto& row : rows) print_row(out, row);
  out << '\n';
}

}  // namespace

void print_hard_cases(std::ostream& out, const NamedResult& result) {
  if (!is_stability(result.document)) return;
  constexpr std::array outcomes{"survived", "survived_smaller", "refused", "diverged",
                                "wrong",    "timeout",          "crashed"};
  std::vector<std::string> solvers;
  std::map<std::string, std::map<std::string, int>> count;
  for (const json& cell : result.document.at("matrix")) {
    const std::string solver = cell.at("solver");
    if (!count.contains(solver)) solvers.push_back(solver);
    ++count[solver][cell.at("outcome")];
  }
  const json& counts = result.document.at("counts");
  out << "## Hard cases (`" << result.name << "`)\n\n"
      << "How each solver ends in small scenes that are known to break solvers; what the outcomes "
         "mean is in [measuring.md](measuring.md#hard-cases). Of "
      << counts.at("cells") << " cells, " << counts.at("strict") << " have one expected outcome, "
      << counts.at("two_admitted")
      << " admit two where theory cannot decide. Not as expected: " << counts.at("not_as_expected")
      << ".\n\n";
  std::vector<std::string> row{"solver"};
  for (const char* outcome : outcomes) row.push_back(std::string(outcome) + ", cases");
  print_head(out, row);
  for (const std::string& solver : solvers) {
    row = {quoted(solver)};
    for (const char* outcome : outcomes) row.push_back(std::to_string(count[solver][outcome]));
    print_row(out, row);
  }
  out << '\n';
  print_differences(out, result.document);
}

}  // namespace harness::tables
