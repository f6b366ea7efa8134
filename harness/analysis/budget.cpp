#include "harness/analysis/budget.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace harness::analysis {

namespace {

// Wall time that 99 % of the frames stay within, s; not-a-number: not measured.
double frame_seconds(const Point& point) {
  for (const FrameTime& frame : point.result().frame_times) {
    if (frame.rate == frame_rate) return frame.slow;
  }
  return std::nan("");
}

Reach reach_of(const Point& point) {
  const double error = point.error_at(headline_error).distance;
  return {point.spec().strain_limit, error, frame_seconds(point), error <= headline_error, point};
}

// Whether a is more than b.
bool more(const Reach& a, const Reach& b) {
  const auto worth = [](const Reach& r) {
    const double error = std::isnan(r.error) ? std::numeric_limits<double>::infinity() : r.error;
    return r.right ? std::tuple(0, r.strain_limit, error) : std::tuple(1, error, -r.strain_limit);
  };
  return worth(a) < worth(b);
}

BudgetTable table_of(std::vector<Point> points, const ContestantRoles& roles,
                     const std::vector<double>& budgets) {
  const PointSpec& one = points.front().spec();
  BudgetTable table{one.scene, one.resolution, one.vertices, budgets, {}};
  const auto row_of = [&](const Point& p) { return roles.at_any_settings(p.contestant()); };
  for (auto& [row, own] : grouped(points, row_of)) {
    Budgeted line{row, roles.of(own.front().contestant()).family, {}, {}};
    std::ranges::stable_sort(own, {}, frame_seconds);
    for (const Point& point : own) {
      const Reach reach = reach_of(point);
      if (line.stairs.empty() || more(reach, line.stairs.back())) line.stairs.push_back(reach);
    }
    for (const double budget : budgets) {
      const auto beyond = std::ranges::upper_bound(line.stairs, budget, {}, &Reach::frame_seconds);
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

std::vector<BudgetTable> budget_tables(const Runs& runs, const std::vector<double>& budgets) {
  std::vector<Point> points = runs.points;
  std::erase_if(points, [&](const Point& p) {
    const Role role = runs.roles.of(p.contestant());
    return p.spec().adaptive || !p.ok() || !role.competes || role.again || !(frame_seconds(p) > 0);
  });
  const auto place_of = [](const Point& p) {
    return std::tuple(p.spec().scene, p.spec().scene_parameters, p.spec().vertices);
  };
  std::vector<BudgetTable> tables;
  for (const auto& [place, here] : grouped(points, place_of))
    tables.push_back(table_of(here, runs.roles, budgets));
  return tables;
}

}  // namespace harness::analysis
