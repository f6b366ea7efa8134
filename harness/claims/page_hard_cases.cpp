#include <array>

#include "harness/claims/page.h"

namespace harness::claims {

using nlohmann::json;

void print_hard_cases(std::ostream& out, const NamedResult& result) {
  if (!is_stability(result.document)) return;
  constexpr std::array outcomes{"survived", "survived_smaller", "refused", "diverged",
                                "wrong",    "timeout",          "crashed"};
  std::vector<std::string> solvers;
  std::map<std::string, std::map<std::string, int>> count;
  int unexpected = 0;
  for (const json& cell : result.document.at("matrix")) {
    const std::string solver = cell.at("solver");
    if (!count.contains(solver)) solvers.push_back(solver);
    ++count[solver][cell.at("outcome")];
    unexpected += cell.at("as_expected").get<bool>() ? 0 : 1;
  }
  out << "## Hard cases (`" << result.name << "`)\n\n"
      << "How each solver ends in small scenes that are known to break solvers; what the outcomes "
         "mean is in [measuring.md](measuring.md#hard-cases). Not as expected: "
      << unexpected << " of " << result.document.at("matrix").size() << ".\n\n";
  std::vector<std::string> row{"solver"};
  for (const char* outcome : outcomes) row.push_back(std::string(outcome) + ", cases");
  print_head(out, row);
  for (const std::string& solver : solvers) {
    row = {quoted(solver)};
    for (const char* outcome : outcomes) row.push_back(std::to_string(count[solver][outcome]));
    print_row(out, row);
  }
  out << '\n';
}

}  // namespace harness::claims
