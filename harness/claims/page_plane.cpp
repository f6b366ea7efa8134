// The plane strain x error: who is fastest within each limit and level of error.
#include <algorithm>
#include <cmath>

#include "harness/analysis/plane.h"
#include "harness/base/text.h"
#include "harness/claims/page.h"

namespace harness::claims {
namespace {

// "`strips` 8.1 ms, 1/100 s, 1.7 (1.5-1.8) `icd`": bold if it is ahead beyond the noise.
std::string cell_text(const Cell& cell) {
  const Entry* first = cell.first();
  if (!first) return cell.empty_because;
  const std::string name = quoted(first->row) + (first->role.hollow ? " `u`" : "");
  std::string text = (cell.clear() ? bold(name) : name) + " " +
                     plain(1e3 * first->point.seconds(), 3) + " ms, " +
                     step_text(first->point.number("step"));
  if (cell.level == any_motion && std::isfinite(first->error))
    text += ", off by " + number_text(100 * first->error, 2) + " %";
  const double shape = first->point.error("shape");
  if (cell.level == any_motion && std::isfinite(shape))
    text += ", shape by " + number_text(100 * shape, 2) + " %";
  if (const Entry* paper = cell.paper_best(); paper && paper != first)
    text += "; " + analysis::text(*cell.lead_over(paper)) + " " + quoted(paper->row);
  return text;
}

bool has_shapes(const Plane& plane) {
  return std::any_of(plane.cells.begin(), plane.cells.end(), [](const Cell& cell) {
    return cell.first() && std::isfinite(cell.first()->point.error("shape"));
  });
}

}  // namespace

void print_planes(std::ostream& out, const NamedResult& result) {
  if (is_stability(result.document)) return;
  for (const Plane& plane : planes_of(result.document)) {
    if (plane.sweep != "strain") continue;
    out << "### " << plane.scene << ", " << plane.vertices << " vertices (`" << result.name
        << "`)\n\nThe fastest within a strain limit and an error: its time for one simulated "
           "second, its step in s, and how many times as long the best of the paper's six takes, "
           "if it is not of them. Errors are over the scene's size."
        << (has_shapes(plane) ? " Shape errors are deviations beyond the ensemble's spread." : "")
        << "\n\n";
    std::vector<std::string> row{"strain"};
    for (const double level : plane.levels)
      row.push_back(level == any_motion ? "any motion" : "error <= " + percent(level));
    print_head(out, row);
    for (const double limit : plane.limits) {
      row = {percent(limit)};
      for (const double level : plane.levels) row.push_back(cell_text(plane.cell(limit, level)));
      print_row(out, row);
    }
    out << '\n';
  }
}

}  // namespace harness::claims
