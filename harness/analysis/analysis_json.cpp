#include "harness/analysis/analysis_json.h"

#include <cmath>

#include "harness/analysis/budget.h"
#include "harness/analysis/findings.h"
#include "harness/base/fields_json.h"

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
          {"step", number(entry.point.number("step"))},
          {"error", number(entry.error)},
          {"shape_error", number(entry.point.error("shape"))},
          {"delivered_strain", number(entry.point.delivered_strain())},
          {"frame_times", entry.point.document().value("frame_times", json())}};
}

json name_of(const Entry* entry) { return entry ? json(entry->row) : json(nullptr); }

json cell_json(const Cell& cell) {
  json entries = json::array();
  for (const Entry& entry : cell.entries) entries.push_back(entry_json(entry));
  const bool any = cell.first() != nullptr;
  return {
      {"strain_limit", cell.strain_limit},
      {"error_level", number(cell.level)},  // null: any motion
      {"known_until", cell.known_until},
      {"empty_because", cell.empty_because},
      {"first", name_of(cell.first())},
      {"clear", cell.clear()},
      {"next_family", any ? name_of(cell.next_family()) : json(nullptr)},
      {"lead_over_next_family",
       ratio_json(any ? cell.lead_over(cell.next_family()) : std::nullopt)},
      {"paper_best", name_of(cell.paper_best())},
      {"lead_over_paper_best", ratio_json(cell.lead_over(cell.paper_best()))},
      {"first_as_published", name_of(cell.first_as_published())},
      {"lead_by_stepper", ratio_json(cell.lead_over(cell.first_as_published()))},
      {"rival_in_stepper", name_of(cell.rival_in_stepper())},
      {"lead_by_method", ratio_json(cell.lead_over(cell.rival_in_stepper()))},
      {"paper_in_any_stepper", name_of(cell.paper_in_any_stepper())},
      {"lead_over_paper_in_any_stepper", ratio_json(cell.lead_over(cell.paper_in_any_stepper()))},
      {"entries", std::move(entries)}};
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
                    {"smallest", row.smallest.number("vertices")},
                    {"largest", row.largest.number("vertices")}});
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

json finding_json(const Finding& finding) {
  return {{"scene", finding.scene},
          {"sweep", finding.sweep},
          {"vertices", finding.vertices},
          {"subject", finding.subject},
          {"sentences", finding.sentences}};
}

}  // namespace

json findings_json(const std::vector<Plane>& planes) {
  json findings = json::array();
  for (const Finding& each : findings_of(planes)) findings.push_back(finding_json(each));
  return findings;
}

json analysis_of(const json& document) {
  const std::vector<Plane> planes = planes_of(document);
  json list = json::array(), growth = json::array(), budgets = json::array();
  for (const Plane& plane : planes) list.push_back(plane_json(plane));
  for (const Growth& each : growth_in(planes)) growth.push_back(growth_json(each));
  for (const BudgetTable& each : budget_tables(document, {})) budgets.push_back(budget_json(each));
  return {{"schema", "inextensible-analysis/1"}, {"headline_error", headline_error},
          {"findings", findings_json(planes)},   {"planes", std::move(list)},
          {"growth", std::move(growth)},         {"budgets", std::move(budgets)}};
}

}  // namespace harness::analysis
