#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <tuple>

#include "harness/analysis/findings.h"
#include "harness/points/point_json.h"

namespace harness::analysis {

using nlohmann::json;

namespace {

json ratio_json(const std::optional<Ratio>& ratio) {
  if (!ratio) return nullptr;
  json object = {{"value", number(ratio->value)}, {"low", nullptr}, {"high", nullptr}};
  if (ratio->known()) {
    object["low"] = ratio->low;
    object["high"] = ratio->high;
  }
  return object;
}

json entry_json(const Entry& entry) {
  return {{"contestant", entry.role.name},
          {"row", entry.row},
          {"unranked", entry.role.unranked},
          {"counts", entry.counts},
          {"id", entry.point.id()},
          {"seconds", number(entry.point.seconds())},
          {"step", number(entry.point.step())},
          {"error", number(entry.error)},
          {"delivered_strain", number(entry.point.delivered_strain())},
          {"frame_times",
           FieldCodec<std::vector<FrameTime>>::write(entry.point.result().frame_times, false)}};
}

json name_of(const Entry* entry) { return entry ? json(entry->row) : json(nullptr); }

json cell_json(const Cell& cell) {
  json entries = json::array();
  for (const Entry& entry : cell.entries) entries.push_back(entry_json(entry));
  json object = {
      {"strain_limit", cell.strain_limit}, {"error_level", number(cell.level)},  // null: any motion
      {"known_until", cell.known_until},   {"empty_because", cell.empty_because},
      {"first", name_of(cell.first())},    {"clear", cell.clear()},
      {"entries", std::move(entries)}};
  for (std::size_t i = 0; i < rival_infos.size(); ++i) {
    const Entry* rival = cell.rival(static_cast<Rival>(i));
    object[rival_infos[i].name] = name_of(rival);
    object[rival_infos[i].lead] = ratio_json(cell.lead_over(rival));
  }
  return object;
}

json plane_json(const Plane& plane) {
  json cells = json::array();
  for (const Cell& cell : plane.cells) cells.push_back(cell_json(cell));
  json levels = json::array();
  for (const double level : plane.levels) levels.push_back(number(level));
  return {{"scene", plane.scene},
          {"sweep", plane.sweep},
          {"scene_parameters", plane.scene_parameters},
          {"resolution", plane.resolution},
          {"vertices", plane.vertices},
          {"strain_limits", plane.limits},
          {"error_levels", std::move(levels)},
          {"leaders", plane.leaders()},
          {"cells", std::move(cells)}};
}

json growth_json(const Growth& growth) {
  json rows = json::array();
  for (const RowGrowth& row : growth.rows) {
    const bool sure = std::isfinite(row.exponent.half_width);
    rows.push_back({{"row", row.row},
                    {"exponent", number(row.exponent.value)},
                    {"low", sure ? json(row.exponent.low()) : json(nullptr)},
                    {"high", sure ? json(row.exponent.high()) : json(nullptr)},
                    {"sizes", row.exponent.points},
                    {"smallest", row.smallest.vertices()},
                    {"largest", row.largest.vertices()}});
  }
  return {{"scene", growth.scene}, {"strain_limit", growth.strain_limit}, {"rows", rows}};
}

json budget_json(const BudgetTable& table) {
  json rows = json::array();
  for (const Budgeted& row : table.rows) {
    json stairs = json::array();
    for (const Reach& reach : row.stairs)
      stairs.push_back({{"id", reach.point.id()},
                        {"frame_seconds", reach.frame_seconds},
                        {"strain_limit", reach.strain_limit},
                        {"error", number(reach.error)},
                        {"right", reach.right}});
    rows.push_back({{"row", row.row}, {"stairs", std::move(stairs)}});
  }
  return {{"scene", table.scene},
          {"resolution", table.resolution},
          {"vertices", table.vertices},
          {"rows", std::move(rows)}};
}

// ---- curves of cost ----

// The least sample, and the median of three or more: between them lies what disturbed the runs.
// Null: not timed.
json time_json(const std::vector<double>& samples) {
  const double least = time_of(samples);
  if (!(least > 0)) return nullptr;
  return {least, samples.size() < 3 ? least : quantile(samples, 0.5)};
}

json best_json(double x, const Point& point) {
  const PointResult& p = point.result();
  return {{"x", x},
          {"time", time_json(p.samples)},
          {"filter", time_json(p.filter_samples)},
          {"step", number(p.mean_step())},
          {"ladder_end", p.at_ladder_end}};
}

// Why none of a contestant's runs counts: the letters of their statuses, from the coarsest step to
// the finest. "": one does count, perhaps at a tighter limit. runs: of one plane, coarsest first.
std::string failure_letters(const std::vector<Point>& runs, double limit, double level) {
  std::string found;
  for (const Point& run : runs) {
    const double kept = run.spec().strain_limit;
    if (kept > limit) continue;
    if (run.ok() && !(run.measures().trajectory > level)) return "";
    const std::string letter =
        run.ok() ? "X" : point_statuses[static_cast<std::size_t>(run.result().status)].letter;
    if (kept == limit && found.find(letter) == found.npos) found += letter;
  }
  return found;
}

// A figure for each scene and sweep, and for what the sweep leaves fixed: vertices, or the limit.
void add_curves(json& list, const Runs& runs, const std::vector<Plane>& planes, bool adaptive) {
  std::vector<Point> points = runs.points;
  std::erase_if(points, [&](const Point& p) {
    return p.spec().adaptive != adaptive || runs.roles.of(p.contestant()).again;
  });
  std::ranges::stable_sort(points, std::greater(), [](const Point& p) { return p.spec().step; });
  std::map<std::tuple<std::string, std::string, double>, json> figures;
  for (const Plane& plane : planes) {
    const bool sizes = plane.sweep == "resolution";
    if (!sizes && plane.sweep != "strain") continue;
    std::map<std::string, std::vector<Point>> own_runs;
    for (const Point& p : points) {
      if (p.spec().scene == plane.scene && p.spec().sweep == plane.sweep &&
          p.spec().vertices == plane.vertices)
        own_runs[p.contestant()].push_back(p);
    }
    for (const double limit : plane.limits) {
      const double fixed = sizes ? limit : plane.vertices, x = sizes ? plane.vertices : limit;
      json& figure = figures[{plane.scene, plane.sweep, fixed}];
      for (const auto& [panel, level] :
           {std::pair("any", any_motion), {"within", headline_error}}) {
        json& curves = figure[panel];
        for (const Entry& entry : plane.cell(limit, level).entries) {
          if (!entry.role.again)
            curves[entry.role.name]["best"].push_back(best_json(x, entry.point));
        }
        for (const auto& [name, own] : own_runs) {
          const std::string why = failure_letters(own, limit, level);
          if (!why.empty()) curves[name]["failures"].push_back({x, why});
        }
      }
    }
  }
  for (auto& [place, figure] : figures) {
    std::tie(figure["scene"], figure["sweep"], figure["fixed"]) = place;
    figure["adaptive"] = adaptive;
    list.push_back(std::move(figure));
  }
}

}  // namespace

json findings_json(const std::vector<Plane>& planes) {
  json findings = json::array();
  for (const Finding& finding : findings_of(planes))
    findings.push_back({{"scene", finding.scene},
                        {"sweep", finding.sweep},
                        {"vertices", finding.vertices},
                        {"subject", finding.subject},
                        {"sentences", finding.sentences}});
  return findings;
}

json analysis_of(const Runs& runs) {
  const std::vector<Plane> planes = planes_of(runs);
  json list = json::array(), growth = json::array(), budgets = json::array();
  for (const Plane& plane : planes) list.push_back(plane_json(plane));
  for (const Growth& each : growth_in(planes)) growth.push_back(growth_json(each));
  for (const BudgetTable& each : budget_tables(runs, {})) budgets.push_back(budget_json(each));
  json curves = json::array();  // runs with a step controller have figures of their own
  add_curves(curves, runs, planes, false);
  add_curves(curves, runs, planes_of(runs, true), true);
  return {{"schema", "inextensible-analysis/1"}, {"headline_error", headline_error},
          {"findings", findings_json(planes)},   {"planes", std::move(list)},
          {"curves", std::move(curves)},         {"growth", std::move(growth)},
          {"budgets", std::move(budgets)}};
}

}  // namespace harness::analysis
