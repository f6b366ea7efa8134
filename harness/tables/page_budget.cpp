// Strain and error of each method within a frame budget.
#include <algorithm>
#include <cmath>

#include "harness/analysis/budget.h"
#include "harness/analysis/words.h"
#include "harness/base/text.h"
#include "harness/tables/page.h"

namespace harness {
namespace {

using namespace tables;

// "0.1 %, error 1.2 %"; in brackets where the motion is not right to the headline's error.
std::string reach_text(const std::optional<Reach>& reach) {
  if (!reach) return "-";
  const std::string error =
      std::isfinite(reach->error) ? number_text(100 * reach->error, 2) + " %" : "not known";
  const std::string text = percent(reach->strain_limit) + ", error " + error;
  return reach->right ? text : "(" + text + ")";
}

}  // namespace

void print_budgets(std::ostream& out, const std::vector<BudgetTable>& tables) {
  for (const BudgetTable& table : tables) {
    out << "### " << scene_words(table.scene) << ", " << table.vertices << " vertices\n\n";
    std::vector<std::string> head{"method"};
    for (const double budget : table.budgets)
      head.push_back(number_text(1e3 * budget) + " ms a frame");
    print_head(out, head);
    std::string none;
    for (const Budgeted& row : table.rows) {
      std::vector<std::string> cells{quoted(row.row)};
      for (const auto& reach : row.reached) cells.push_back(reach_text(reach));
      const bool any = std::any_of(row.reached.begin(), row.reached.end(),
                                   [](const auto& reach) { return reach.has_value(); });
      if (any) {
        print_row(out, cells);
      } else {
        none += (none.empty() ? "" : ", ") + cells.front();
      }
    }
    if (!none.empty()) out << "\nNo run is that fast: " << none << ".\n";
    out << '\n';
  }
}

}  // namespace harness
