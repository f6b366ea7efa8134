#include "harness/compare/gate.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/points/point_json.h"

namespace harness {
namespace {

using nlohmann::json;
using Names = std::vector<std::string>;

// An object of the file: only keys that are known.
const json& checked_object(const json& value, const std::string& where, const Names& known) {
  if (!value.is_object())
    throw UsageError(where + " is " + value.dump() + ", must be an object { ... }");
  for (const auto& [key, ignored] : value.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw UsageError(where + ": " + unknown_name("key", key, known).what());
  }
  return value;
}

// least: permitted itself unless `above`.
void read_number(const json& object, const std::string& where, const char* key, double least,
                 bool above, double most, double& into) {
  const auto place = object.find(key);
  if (place == object.end()) return;
  const double number = place->is_number() ? place->get<double>() : unknown;
  const bool fits = (above ? number > least : number >= least) && number <= most;
  if (!fits) {
    json bound = least;
    std::string wanted = (above ? "a number above " : "a number of at least ") + bound.dump();
    if (most < 1e300) wanted += " and at most " + json(most).dump();
    throw UsageError(where + ": '" + key + "' is " + place->dump() + ", must be " + wanted);
  }
  into = number;
}

void read_times(const json& value, const std::string& where, Gate& gate) {
  const json& object =
      checked_object(value, where, {"count", "significance", "median_ratio", "minimum_ratio"});
  if (const auto count = object.find("count"); count != object.end()) {
    if (!count->is_boolean())
      throw UsageError(where + ": 'count' is " + count->dump() + ", must be true or false");
    gate.times = count->get<bool>();
  }
  read_number(object, where, "significance", 0, true, 0.5, gate.significance);
  read_number(object, where, "median_ratio", 1, false, 1e300, gate.median_ratio);
  read_number(object, where, "minimum_ratio", 1, false, 1e300, gate.minimum_ratio);
}

void read_counters(const json& value, const std::string& where, Gate& gate) {
  const json& object = checked_object(value, where, {"rule", "names"});
  if (const auto rule = object.find("rule"); rule != object.end()) {
    static const Names rules{"exact", "rise", "inform"};  // in the order of CounterRule
    const std::string name = rule->is_string() ? rule->get<std::string>() : rule->dump();
    const auto place = std::find(rules.begin(), rules.end(), name);
    if (place == rules.end())
      throw UsageError(where + ": 'rule': " + unknown_name("rule", name, rules).what());
    gate.counter_rule = static_cast<CounterRule>(place - rules.begin());
  }
  if (const auto names = object.find("names"); names != object.end()) {
    if (!names->is_array() || names->empty())
      throw UsageError(where + ": 'names' is " + names->dump() + ", must be a list of counters");
    const Names known = counter_names();
    for (const json& item : *names) {
      const std::string name = item.is_string() ? item.get<std::string>() : item.dump();
      if (std::find(known.begin(), known.end(), name) == known.end())
        throw UsageError(where + ": 'names': " + unknown_name("counter", name, known).what());
      gate.counters.push_back(name);
    }
  }
}

void read_errors(const json& value, const std::string& where, Gate& gate) {
  Names known = error_names();
  known.emplace_back("floor");
  const json& object = checked_object(value, where, known);
  gate.errors.clear();
  for (const std::string& name : error_names()) {
    if (object.contains(name))
      read_number(object, where, name.c_str(), 1, false, 1e300, gate.errors[name]);
  }
  read_number(object, where, "floor", 0, false, 1e300, gate.error_floor);
}

}  // namespace

std::vector<std::string> counter_names() {
  Names names;
  const json work = to_json(inextensible::WorkCounters());
  for (const auto& entry : work.items()) names.push_back(entry.key());
  names.emplace_back("calibration_runs");
  return names;
}

std::vector<std::string> error_names() { return {"max_strain", "trajectory", "energy_drift"}; }

Gate read_gate(const std::string& path) { return parse_gate(read_file(path, "gate"), path); }

Gate parse_gate(const std::string& text, const std::string& path) {
  json document;
  try {
    document = json::parse(text, nullptr, true, /*ignore_comments=*/true);
  } catch (const json::exception& error) {
    throw UsageError("'" + path + "' is not JSON: " + error.what());
  }
  const std::string where = "gate '" + path + "'";
  checked_object(document, where, {"times", "counters", "errors"});
  Gate gate;
  if (document.contains("times")) read_times(document["times"], where + ": 'times'", gate);
  if (document.contains("counters"))
    read_counters(document["counters"], where + ": 'counters'", gate);
  if (document.contains("errors")) read_errors(document["errors"], where + ": 'errors'", gate);
  return gate;
}

}  // namespace harness
