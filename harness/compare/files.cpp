// What is compared, read from files: gates, results and baselines; and a baseline written.
#include "harness/base/files.h"

#include <algorithm>

#include "harness/base/errors.h"
#include "harness/base/json_reader.h"
#include "harness/base/text.h"
#include "harness/compare/comparison.h"
#include "harness/points/context.h"
#include "harness/points/result_file.h"
#include "harness/points/schema.h"

namespace harness {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using Names = std::vector<std::string>;

constexpr std::array error_names{"max_strain", "trajectory", "energy_drift"};

void read_times(JsonReader reader, Gate& gate) {
  const Bounds ratio = Bounds::at_least(1);
  gate.times = reader.flag("count", gate.times);
  gate.significance =
      reader.number("significance", gate.significance, {.least = 0, .above = true, .most = 0.5});
  gate.median_ratio = reader.number("median_ratio", gate.median_ratio, ratio);
  gate.minimum_ratio = reader.number("minimum_ratio", gate.minimum_ratio, ratio);
  reader.finish();
}

void read_counters(JsonReader reader, Gate& gate) {
  static const Names rules{"exact", "rise", "inform"};  // in the order of CounterRule
  const std::string rule = reader.one_of("rule", rules.front(), rules, "rule");
  gate.counter_rule =
      static_cast<CounterRule>(std::find(rules.begin(), rules.end(), rule) - rules.begin());
  const Names known = counter_names();
  for (const std::string& name : reader.texts("names")) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw UsageError(reader.where("names") + ": " + unknown_name("counter", name, known).what());
    gate.counters.push_back(name);
  }
  reader.finish();
}

void read_errors(JsonReader reader, Gate& gate) {
  gate.errors.clear();
  for (const char* name : error_names) {
    if (reader.find(name)) gate.errors[name] = reader.number(name, 1, Bounds::at_least(1));
  }
  gate.error_floor = reader.number("floor", gate.error_floor, Bounds::at_least(0));
  reader.finish();
}

}  // namespace

Gate read_gate(const std::string& path) { return parse_gate(read_file(path, "gate"), path); }

Gate parse_gate(const std::string& text, const std::string& path) {
  const json document = parse_commented(text, path);
  JsonReader reader(document, "gate '" + path + "'");
  Gate gate;
  const auto part = [&reader](const char* key, auto read) {
    if (const json* value = reader.find(key)) read(JsonReader(*value, reader.where(key)));
  };
  part("times", [&gate](const JsonReader& times) { read_times(times, gate); });
  part("counters", [&gate](const JsonReader& counters) { read_counters(counters, gate); });
  part("errors", [&gate](const JsonReader& errors) { read_errors(errors, gate); });
  reader.finish();
  return gate;
}

namespace {

constexpr const char* baseline_schema = "inextensible-baseline/1";
constexpr int error_digits = 6;  // enough for a ratio; the rest is noise in a diff

std::string spec_hash(const json& point) {
  const json spec = {point.at("scene_parameters"), point.value("settings", json::object()),
                     point.value("adaptive", false), point.at("seed")};
  return fnv1a(spec.dump());
}

json error_of(const json& point, const std::string& name) {
  return (name == "max_strain" ? point : point.at("error")).value(name, json());
}

json read_any(const std::string& path) {
  json document = parse_document(read_file(path, "result file"), path);
  const json schema = document.is_object() ? document.value("schema", json()) : json();
  if (schema == "inextensible-stability/1")
    throw UsageError("'" + path +
                     "' is the result of a stability sweep, which cannot be compared: it has its "
                     "expected outcomes in the program");
  if (schema == baseline_schema) {
    check_schema(document, "baseline", path);
  } else {
    check_result(document, path);
  }
  return document;
}

// Whether the steps of this point's search were chosen by their times.
bool searched(const json& suite, const ComparedPoint& point) {
  if (point.sweep == "step") return false;
  const std::string scene = point.id.substr(0, point.id.find('/'));
  for (const json& sweep : suite.at("sweeps")) {
    if (sweep.at("sweep") != point.sweep || sweep.at("scene") != scene) continue;
    const json steps = sweep.value("steps", json::object());
    if (steps.value("all", false) || steps.value("adaptive", false)) return false;
  }
  return true;
}

void append(ComparedResult& to, const json& document, const std::string& path) {
  try {
    const json& context = document.at("context");
    for (const json& entry : document.at("points")) {
      ComparedPoint point = compared_point(entry);
      point.searched = searched(context.at("suite"), point);
      to.points.push_back(std::move(point));
    }
    to.complete = to.complete && document.value("complete", true);
    to.baseline = to.baseline || document.at("schema") == baseline_schema;
    if (to.context.is_null()) {
      to.context = context;
      return;
    }
    for (const char* key : {"fingerprint", "counters_fingerprint"}) {
      if (to.context.value(key, "") != context.value(key, ""))
        throw UsageError("'" + to.path + "' and '" + path +
                         "' are not of one build on one machine, so they are not one result");
    }
  } catch (const json::exception& error) {
    throw UsageError("'" + path + "' is not a result file: " + error.what());
  }
}

std::string command_line(const json& words) {
  std::string line;
  for (const json& word : words) {
    const std::string text = word.get<std::string>();
    const bool plain = text.find_first_of(" |()$*?^'\"[]\\") == std::string::npos;
    line += (line.empty() ? "" : " ") + (plain ? text : "'" + text + "'");
  }
  return line;
}

ordered_json rounded(const json& value) {
  if (!value.is_number()) return nullptr;
  return rounded_to(value.get<double>(), error_digits);
}

ordered_json baseline_point(const json& point) {
  ordered_json errors = ordered_json::object();
  for (const char* name : {"trajectory", "energy_drift"})
    errors[name] = rounded(error_of(point, name));
  return {{"sweep", point.at("sweep")},
          {"id", point.at("id")},
          {"status", point.at("status")},
          {"spec", spec_hash(point)},
          {"work", point.at("work")},
          {"max_strain", rounded(point.at("max_strain"))},
          {"error", errors}};
}

}  // namespace

ComparedPoint compared_point(const json& p) {
  ComparedPoint point;
  p.at("sweep").get_to(point.sweep);
  p.at("id").get_to(point.id);
  p.at("status").get_to(point.status);
  point.detail = p.value("status_detail", "");
  point.spec = p.contains("spec") ? p.at("spec").get<std::string>() : spec_hash(p);
  point.best = p.value("best", false);
  p.at("work").get_to(point.counters);
  for (const char* name : error_names) {
    if (const json value = error_of(p, name); value.is_number()) point.errors[name] = value;
  }
  const json seconds = p.value("seconds_per_simulated_second", json());
  if (seconds.is_object()) seconds.at("samples").get_to(point.samples);
  return point;
}

ComparedResult read_compared(const std::vector<std::string>& paths) {
  ComparedResult result;
  for (const std::string& path : paths) {
    if (result.path.empty()) result.path = path;
    append(result, read_any(path), path);
  }
  return result;
}

ordered_json baseline_document(const std::vector<json>& results) {
  const json& context = results.front().at("context");
  ordered_json suite = context.at("suite"), commands = ordered_json::array(), points;
  points = ordered_json::array();
  suite["sweeps"] = ordered_json::array();
  for (const json& result : results) {
    commands.push_back(command_line(result.at("context").at("command")));
    for (const json& sweep : result.at("context").at("suite").at("sweeps"))
      suite["sweeps"].push_back(ordered_json(sweep));
    for (const json& point : result.at("points")) points.push_back(baseline_point(point));
  }
  return {{"schema", baseline_schema},
          {"context",
           {{"counters_fingerprint", context.value("counters_fingerprint", "")},
            {"build", context.at("build")},
            {"libraries", context.at("libraries")},
            {"command", commands},
            {"suite", suite}}},
          {"points", points}};
}

}  // namespace harness
