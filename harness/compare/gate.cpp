#include "harness/compare/gate.h"

#include <algorithm>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/points/schema.h"

namespace harness {
namespace {

using nlohmann::json;
using Names = std::vector<std::string>;

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
  for (const std::string& name : error_names()) {
    if (reader.find(name)) gate.errors[name] = reader.number(name, 1, Bounds::at_least(1));
  }
  gate.error_floor = reader.number("floor", gate.error_floor, Bounds::at_least(0));
  reader.finish();
}

}  // namespace

std::vector<std::string> error_names() { return {"max_strain", "trajectory", "energy_drift"}; }

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

}  // namespace harness
