// Gates, results and baselines read; baselines and tables written.
#include "harness/base/files.h"

#include "harness/base/table.h"
#include "harness/compare/comparison.h"
#include "harness/points/result_file.h"
#include "harness/points/schema.h"

namespace harness {
namespace {

using nlohmann::ordered_json;

constexpr const char* baseline_schema = "inextensible-baseline/1";
constexpr std::array errors_of_runs{"trajectory", "energy_drift"};  // and max_strain

json read_any(const std::string& path) {
  json document = parse_document(read_file(path, "result file"), path);
  const json schema = document.is_object() ? document.value("schema", json()) : json();
  if (schema == "inextensible-stability/1")
    throw UsageError("'" + path +
                     "' is the result of a stability sweep, which cannot be compared: it has its "
                     "expected outcomes in the program");
  if (schema == baseline_schema)
    check_schema(document, "baseline", path);
  else
    check_result(document, path);
  return document;
}

bool searched(const json& suite, const json& point) {
  if (point.at("sweep") == "step") return false;
  const std::string id = point.at("id");  // of a baseline, which leaves out the scene
  const std::string scene = point.value("scene", id.substr(0, id.find('/')));
  for (const json& sweep : suite.at("sweeps")) {
    if (sweep.at("sweep") != point.at("sweep") || sweep.at("scene") != scene) continue;
    if (sweep.value("steps", json::object()).value("all", false)) return false;
  }
  return true;
}

std::string shell_line(const json& words) {
  std::string line;
  for (const std::string text : words) {
    const bool plain = text.find_first_of(" |()$*?^'\"[]\\") == std::string::npos;
    append(line, plain ? text : "'" + text + "'", " ");
  }
  return line;
}

void add_file(ComparedResult& to, const json& document, const std::string& path) {
  const json& context = document.at("context");
  for (const json& entry : document.at("points")) {
    to.points.push_back(compared_point(entry));
    to.points.back().searched = searched(context.at("suite"), entry);
  }
  to.complete = to.complete && document.value("complete", true);
  to.baseline = to.baseline || document.at("schema") == baseline_schema;
  if (!to.baseline) to.commands.push_back(shell_line(context.at("command")));
  if (to.context.is_null()) {
    to.path = path;
    to.context = context;
    return;
  }
  for (const char* key : {"fingerprint", "counters_fingerprint"})
    if (to.context.value(key, "") != context.value(key, ""))
      throw UsageError("'" + to.path + "' and '" + path +
                       "' are not of one build on one machine, so they are not one result");
  for (const json& sweep : context.at("suite").at("sweeps"))
    to.context["suite"]["sweeps"].push_back(sweep);
}

}  // namespace

Gate read_gate(const std::string& path) { return parse_gate(read_file(path, "gate"), path); }

Gate parse_gate(const std::string& text, const std::string& path) {
  const json document = parse_document(text, path);
  check_schema(document, "gate", path);
  const auto part = [&document](const char* key) { return document.value(key, json::object()); };
  const json times = part("times"), counters = part("counters"), errors = part("errors");
  const std::map<std::string, CounterRule> rules{
      {"exact", CounterRule::exact}, {"rise", CounterRule::rise}, {"inform", CounterRule::inform}};
  Gate gate;
  gate.times = times.value("count", gate.times);
  gate.significance = times.value("significance", gate.significance);
  gate.median_ratio = times.value("median_ratio", gate.median_ratio);
  gate.minimum_ratio = times.value("minimum_ratio", gate.minimum_ratio);
  gate.counter_rule = rules.at(counters.value("rule", "exact"));
  gate.counters = counters.value("names", gate.counters);
  if (document.contains("errors")) gate.errors.clear();
  for (const char* name : {"max_strain", "trajectory", "energy_drift"})
    if (errors.contains(name)) gate.errors[name] = errors.at(name);
  gate.error_floor = errors.value("floor", gate.error_floor);
  return gate;
}

ComparedPoint compared_point(const json& p) {
  ComparedPoint point{p.at("sweep"), p.at("id"), p.at("status"), p.value("status_detail", "")};
  point.best = p.value("best", false);
  point.fingerprint = p.value("counters_fingerprint", "");
  point.counters = p.at("work");
  if (p.at("max_strain").is_number()) point.errors["max_strain"] = p.at("max_strain");
  for (const char* name : errors_of_runs)
    if (const json error = p.at("error").value(name, json()); error.is_number())
      point.errors[name] = error;
  point.spec =
      p.contains("spec")  // of a baseline
          ? p.at("spec").get<std::string>()
          : fnv1a(json{p.at("scene_parameters"), p.value("settings", json::object()), p.at("seed")}
                      .dump());
  const json seconds = p.value("seconds_per_simulated_second", json());
  if (seconds.is_object()) seconds.at("samples").get_to(point.samples);
  return point;
}

ComparedResult read_compared(const std::vector<std::string>& paths) {
  ComparedResult result;
  for (const std::string& path : paths) {
    const json document = read_any(path);
    try {
      add_file(result, document, path);
    } catch (const json::exception& error) {
      throw UsageError("'" + path + "' is not a result file: " + error.what());
    }
  }
  return result;
}

ordered_json baseline_document(const ComparedResult& result) {
  ordered_json context, points = ordered_json::array();
  for (const char* key : {"counters_fingerprint", "build", "libraries"})
    context[key] = result.context.value(key, json(""));
  context["command"] = result.commands;
  context["suite"] = result.context.at("suite");
  for (const ComparedPoint& point : result.points) {
    const auto rounded = [&point](const char* name) {
      constexpr int digits = 6;  // enough for a ratio; the rest is noise in a diff
      const auto error = point.errors.find(name);
      return error == point.errors.end() ? ordered_json()
                                         : ordered_json(rounded_to(error->second, digits));
    };
    ordered_json errors;
    for (const char* name : errors_of_runs) errors[name] = rounded(name);
    points.push_back({{"sweep", point.sweep},
                      {"id", point.id},
                      {"status", point.status},
                      {"spec", point.spec},
                      {"work", point.counters},
                      {"max_strain", rounded("max_strain")},
                      {"error", errors}});
  }
  return {{"schema", baseline_schema}, {"context", context}, {"points", points}};
}

// ---- Reports ----

namespace {

std::vector<PointChange> rows_of(const Comparison& comparison) {
  std::vector<PointChange> rows = comparison.points;
  std::erase_if(rows,
                [](const PointChange& point) {  // SAME with a reason: the gate only reports it
                  return point.too_few || (point.change == Change::same && point.reasons.empty());
                });
  std::ranges::stable_sort(rows, {}, &PointChange::change);
  return rows;
}

std::string counts(const Comparison& comparison) {
  std::string text;
  for (std::size_t i = 0; i < change_names.size(); ++i)
    if (const std::size_t n = comparison.count(static_cast<Change>(i)); n > 0)
      append(text, std::to_string(n) + " " + change_names[i]);
  return counted(comparison.points.size(), "point") + ": " + text;
}

}  // namespace

void print_comparison(std::ostream& out, const Comparison& comparison) {
  Table table;
  for (const PointChange& row : rows_of(comparison))
    table.rows.push_back({to_string(row.change), row.sweep + " " + row.id, row.text()});
  print_aligned(out, table);
  if (!table.rows.empty()) out << '\n';
  for (const std::string& note : comparison.notes) out << "note: " << note << '\n';
  // Points with too few runs to decide on their times share one note.
  const auto& points = comparison.points;
  const auto example = std::ranges::find_if(points, &PointChange::too_few);
  if (example != points.end())
    out << "note: " << std::ranges::count(points, true, &PointChange::too_few)
        << " of the AMBIGUOUS have too few runs, for example " << example->id << ": "
        << example->text() << '\n';
  out << counts(comparison) << std::endl;
}

}  // namespace harness
