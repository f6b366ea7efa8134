// The fastest method within each strain limit and level of error, and strain and error of each
// method within a frame budget.
#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/analysis/findings.h"
#include "harness/base/text.h"
#include "harness/points/result_file.h"
#include "harness/tables/tables.h"

namespace harness {

using namespace analysis;  // tables print what was analysed

namespace {

// "`yarn_projection` 8.1 ms, 1/100 s, 1.7 (1.5-1.8) `icd`": bold if it is ahead beyond the noise.
std::string cell_text(const Cell& cell) {
  const Entry* first = cell.first();
  if (!first) return cell.empty_because;
  const std::string name = quoted(first->row) + (first->role.unranked ? " `u`" : "");
  std::string text = (cell.clear() ? "**" + name + "**" : name) + " " +
                     plain(1e3 * first->point.seconds(), 3) + " ms, " +
                     step_text(first->point.step());
  if (const double kept = first->point.strain_limit(); kept < cell.strain_limit)
    text += " at " + percent(kept);
  if (cell.level == any_motion && std::isfinite(first->error))
    text += ", off by " + number_text(100 * first->error, 2) + " %";
  if (const Entry* paper = cell.rival(Rival::paper_best); paper && paper != first)
    text += "; " + analysis::text(*cell.lead_over(paper)) + " " + quoted(paper->row);
  return text;
}

Table table_of(const std::vector<Plane>& planes) {
  const bool sizes = planes.front().sweep == "resolution";
  Table table{{sizes ? "vertices" : "strain"}, {}, 0};
  for (const double level : planes.front().levels)
    table.head.push_back(level == any_motion ? "any motion" : "error <= " + percent(level));
  for (const Plane& plane : planes) {
    for (const Cell& cell : plane.cells) {  // by limit, then by level
      if (cell.level == plane.levels.front())
        table.rows.push_back({sizes ? std::to_string(plane.vertices) : percent(cell.strain_limit)});
      table.rows.back().push_back(cell_text(cell));
    }
  }
  return table;
}

// How much of the lead at the headline's error is the time stepper's, and how much the method's: at
// 1 % strain. The figure has all limits.
void print_attribution(std::ostream& out, const Plane& plane) {
  constexpr double limit = 0.01;
  for (const Cell& cell : plane.cells) {
    const Entry* first = cell.first();
    if (cell.level != headline_error || cell.strain_limit != limit || !first) continue;
    out << "Where the lead of " << quoted(first->row) << " at " << percent(limit)
        << " comes from, in times its time: ";
    for (const auto& [words, which] :
         {std::pair("the same method as published ", Rival::first_as_published),
          {"; the next method in the same stepper ", Rival::rival_in_stepper},
          {"; the paper's best as published ", Rival::paper_best},
          {", in any stepper ", Rival::paper_in_any_stepper}}) {
      const Entry* other = cell.rival(which);
      out << words
          << (!other           ? "none in these results"
              : other == first ? "itself"
                               : analysis::text(*cell.lead_over(other)) + " " + quoted(other->row));
    }
    out << ". ";
  }
}

// How much of each method's least error at 1 % is slack: what a limit of 0.1 % takes away at the
// same step.
void print_slack(std::ostream& out, const Runs& runs, const Plane& plane) {
  constexpr double loose = 0.01, tight = 0.001;
  std::string text;
  for (const auto& [name, own] :
       grouped(runs.points, [](const Point& p) { return p.contestant(); })) {
    if (!runs.roles.of(name).ranked()) continue;
    double error = unknown, kept = unknown;
    for (const Point& p : own) {
      const auto tighter = std::ranges::find_if(own, [&p, &plane](const Point& q) {
        return q.ok() && q.step() == p.step() && q.strain_limit() == tight &&
               q.scene() == plane.scene && q.vertices() == plane.vertices &&
               q.sweep() == plane.sweep;
      });
      const double now = p.error_at(headline_error).distance;
      if (p.ok() && p.strain_limit() == loose && p.scene() == plane.scene &&
          p.vertices() == plane.vertices && tighter != own.end() && !(error < now)) {
        error = now;
        kept = tighter->error_at(headline_error).distance;
      }
    }
    if (!(error > 0) || !std::isfinite(kept)) continue;
    text += (text.empty() ? "" : ", ") + quoted(name) + " " + number_text(100 * error, 2) + " % (" +
            number_text(100 * std::max(0.0, 1 - kept / error), 2) + " %)";
  }
  if (!text.empty())
    out << "The least error at " << percent(loose)
        << ", and in brackets how much of it is slack, which a limit of " << percent(tight)
        << " takes away at the same step: " << text << ". ";
}

// "0.1 %, error 1.2 %"; in brackets where the motion is not right to the headline's error.
std::string reach_text(const std::optional<Reach>& reach) {
  if (!reach) return "-";
  const std::string text =
      percent(reach->strain_limit) + ", error " +
      (std::isfinite(reach->error) ? number_text(100 * reach->error, 2) + " %" : "not known");
  return reach->right ? text : "(" + text + ")";
}

}  // namespace

std::string span_of_errors(const std::vector<Plane>& planes) {
  double first = std::numeric_limits<double>::infinity(), last = 0, duration = 0;
  for (const Plane& plane : planes) {
    for (const Cell& cell : plane.cells) {
      if (cell.level != headline_error || !cell.first() || cell.known_until == 0) continue;
      first = std::min(first, cell.known_until);
      last = std::max(last, cell.known_until);
      duration = std::max(duration, cell.first()->point.duration());
    }
  }
  if (last == 0 || first > duration * (1 - 1e-9)) return "";
  return "Errors of " + percent(headline_error) + " are known up to " +
         (first < last ? number_text(first) + " or " : "") + number_text(last) + " s of " +
         number_text(duration) + " s: later the scene's references differ too much. ";
}

std::string title_of(const Plane& plane) {
  return plane.sweep == "resolution"
             ? scene_words(plane.scene) + " over resolution, " + percent(plane.limits.front()) +
                   " strain"
             : scene_words(plane.scene) + ", " + std::to_string(plane.vertices) +
                   " vertices, over " + plane.sweep;
}

void print_planes(std::ostream& out, const std::vector<nlohmann::json>& sweeps) {
  if (sweeps.empty()) return;
  const Runs runs(joined(sweeps));
  std::vector<Plane> all = planes_of(runs);
  std::erase_if(all, [](const Plane& plane) {
    return std::ranges::none_of(plane.cells, [](const Cell& cell) { return cell.counting(1); });
  });
  for (const auto& [title, planes] : grouped(all, title_of)) {
    out << "### " << title << "\n\n";
    for (const Finding& finding : findings_of(planes)) {
      for (const std::string& sentence : finding.sentences) out << sentence << ' ';
    }
    out << span_of_errors(planes);
    for (const Plane& plane : planes) {
      if (plane.sweep == "strain") print_attribution(out, plane);
      if (plane.scene == "settling_drape") print_slack(out, runs, plane);
    }
    out << "\n\n";
    print_markdown(out, table_of(planes));
    out << '\n';
  }
}

void print_budgets(std::ostream& out, const std::vector<BudgetTable>& places) {
  for (const BudgetTable& place : places) {
    Table table{{"method"}};
    for (const double budget : place.budgets)
      table.head.push_back(number_text(1e3 * budget) + " ms a frame");
    std::string none;
    for (const Budgeted& row : place.rows) {
      if (std::ranges::none_of(row.reached, [](const auto& reach) { return reach.has_value(); })) {
        none += (none.empty() ? "" : ", ") + quoted(row.row);
        continue;
      }
      table.rows.push_back({row.row});
      for (const auto& reach : row.reached) table.rows.back().push_back(reach_text(reach));
    }
    out << "### " << scene_words(place.scene) << ", " << place.vertices << " vertices\n\n";
    print_markdown(out, table);
    if (!none.empty()) out << "\nNo run is that fast: " << none << ".\n";
    out << '\n';
  }
}

}  // namespace harness
