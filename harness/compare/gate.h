// What a comparison of results lets pass: configs/gate.json, schema configs/gate.schema.json.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace harness {

enum class CounterRule {
  exact,   // any difference fails, fewer iterations too: the base is then to be renewed
  rise,    // only more work fails
  inform,  // differences are counted and told, and nothing fails
};

struct Gate {
  bool times = true;  // whether times count at all
  // A time has changed if all three say so.
  double significance = 0.05;  // one-sided Mann-Whitney p below this
  double median_ratio = 1.05;
  double minimum_ratio = 1.03;
  CounterRule counter_rule = CounterRule::exact;
  std::vector<std::string> counters;  // names of `work` in a result file; all of them if empty
  // Largest permitted ratio of new to base of "max_strain", "trajectory" and "energy_drift"; what
  // is not there does not count.
  std::map<std::string, double> errors{
      {"max_strain", 1.001}, {"trajectory", 1.01}, {"energy_drift", 1.01}};
  double error_floor = 1e-9;  // an error below this is rounding
};

std::vector<std::string> error_names();

// Both throw UsageError, naming file, key and value, for anything that is not a gate.
Gate read_gate(const std::string& path);
Gate parse_gate(const std::string& text, const std::string& path);

}  // namespace harness
