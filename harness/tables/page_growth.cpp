// How the time of a step grows with the number of vertices: a row a solver, a column a scene.
#include "harness/analysis/growth.h"
#include "harness/analysis/words.h"
#include "harness/base/in_order.h"
#include "harness/base/text.h"
#include "harness/tables/page.h"

namespace harness::tables {
namespace {

// "1.13 (1.05 to 1.21), to 5041: 12.4 ms".
std::string cell_text(const std::vector<RowGrowth>& rows, const std::string& name) {
  for (const RowGrowth& row : rows) {
    if (row.row == name)
      return exponent_words(row.exponent) + "; " +
             time_words(row.largest.seconds() * row.largest.number("step")) + " at " +
             number_text(row.largest.number("vertices"), 7);
  }
  return "-";
}

}  // namespace

void print_growth(std::ostream& out, const std::vector<NamedResult>& results) {
  std::vector<Growth> all;
  for (const NamedResult& result : results) {
    if (is_stability(result.document)) continue;
    for (Growth& growth : growth_in(planes_of(result.document))) all.push_back(std::move(growth));
  }
  if (all.empty()) return;
  out << "## Growth\n\nThe time of a step, whatever the motion, grows as the number of vertices to "
         "this power (95 % interval); and what a step takes at the largest size.\n\n";
  std::vector<std::string> row{"solver"}, names;
  for (const Growth& growth : all) {
    row.push_back(scene_words(growth.scene) + " at " + percent(growth.strain_limit) + ", from " +
                  number_text(growth.rows.front().smallest.number("vertices"), 7));
    for (const RowGrowth& each : growth.rows) names.push_back(each.row);
  }
  print_head(out, row);
  for (const std::string& name : in_order(names, [](const std::string& text) { return text; })) {
    row = {quoted(name)};
    for (const Growth& growth : all) row.push_back(cell_text(growth.rows, name));
    print_row(out, row);
  }
  out << '\n';
}

}  // namespace harness::tables
