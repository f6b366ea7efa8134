#include "harness/analysis/budget.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "harness/base/in_order.h"
#include "harness/points/suite.h"

namespace harness::analysis {

using nlohmann::json;

namespace {

// Wall time that 99 % of the frames stay within, s; not-a-number: not measured.
double frame_seconds(const Point& point) {
  const auto frames = point.document().find("frame_times");
  if (frames == point.document().end()) return std::nan("");
  for (const json& frame : *frames) {  // rate, median, 99 %, worst
    if (frame.at(0) == frame_rate && frame.at(2).is_number()) return frame.at(2);
  }
  return std::nan("");
}

struct Run {
  std::string row, family;
  Reach reach;
};

std::optional<Run> run_of(const json& document, const ContestantRoles& roles, double noise) {
  const Point point(document, noise);
  if (document.value("adaptive", false) || !point.ok()) return std::nullopt;
  const Role role = roles.of(point.contestant());
  const double frame = frame_seconds(point);
  if (!role.competes || role.again || !(frame > 0)) return std::nullopt;
  const double error = point.error_at(headline_error).distance;
  return Run{roles.at_any_settings(point.contestant()),
             role.family,
             {point.number("strain_limit"), error, frame, error <= headline_error, point}};
}

// Whether a is more than b.
bool more(const Reach& a, const Reach& b) {
  const auto worth = [](const Reach& r) {
    const double error = std::isnan(r.error) ? std::numeric_limits<double>::infinity() : r.error;
    return r.right ? std::tuple(0, r.strain_limit, error) : std::tuple(1, error, -r.strain_limit);
  };
  return worth(a) < worth(b);
}

BudgetTable table_of(const std::vector<const Run*>& runs, const std::vector<double>& budgets) {
  const Point& one = runs.front()->reach.point;
  BudgetTable table{one.text("scene"),
                    static_cast<int>(one.number("resolution")),
                    static_cast<int>(one.number("vertices")),
                    budgets,
                    {}};
  std::vector<const Run*> ascending = runs;
  std::stable_sort(ascending.begin(), ascending.end(), [](const Run* a, const Run* b) {
    return a->reach.frame_seconds < b->reach.frame_seconds;
  });
  for (const std::string& row : in_order(runs, [](const Run* run) { return run->row; })) {
    Budgeted line{row, "", {}, {}};
    for (const Run* run : ascending) {
      if (run->row != row) continue;
      line.family = run->family;
      if (line.stairs.empty() || more(run->reach, line.stairs.back()))
        line.stairs.push_back(run->reach);
    }
    for (const double budget : budgets) {
      const auto beyond =
          std::find_if(line.stairs.begin(), line.stairs.end(),
                       [budget](const Reach& reach) { return reach.frame_seconds > budget; });
      line.reached.push_back(beyond == line.stairs.begin() ? std::nullopt
                                                           : std::optional(*std::prev(beyond)));
    }
    table.rows.push_back(std::move(line));
  }
  std::stable_sort(table.rows.begin(), table.rows.end(), [](const Budgeted& a, const Budgeted& b) {
    for (std::size_t i = a.reached.size(); i-- > 0;) {
      const auto &p = a.reached[i], &q = b.reached[i];
      if (!p || !q) {
        if (p.has_value() != q.has_value()) return p.has_value();
        continue;
      }
      if (more(*p, *q) != more(*q, *p)) return more(*p, *q);
    }
    return false;
  });
  return table;
}

}  // namespace

std::vector<BudgetTable> budget_tables(const json& document, const std::vector<double>& budgets) {
  std::vector<Run> runs;
  const ContestantRoles roles(document);
  const double noise = pair_noise_of(document);
  for (const json& p : document.at("points")) {
    if (auto run = run_of(p, roles, noise)) runs.push_back(std::move(*run));
  }
  const auto place_of = [](const Run& run) {
    const json& p = run.reach.point.document();
    return std::tuple(run.reach.point.text("scene"),
                      p.value("scene_parameters", json::object()).dump(),
                      run.reach.point.number("vertices"));
  };
  std::vector<BudgetTable> tables;
  for (const auto& place : in_order(runs, place_of)) {
    std::vector<const Run*> here;
    for (const Run& run : runs) {
      if (place_of(run) == place) here.push_back(&run);
    }
    tables.push_back(table_of(here, budgets));
  }
  return tables;
}

}  // namespace harness::analysis
