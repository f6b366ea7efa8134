// Results as far as they can be compared with others, and the baseline: a result without times, one
// point a line, for a repository (schema inextensible-baseline/1, configs/baseline.schema.json).
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace harness {

struct ComparedPoint {
  std::string sweep, id, status, detail;
  std::string spec;       // a hash of what is run: parameters, settings, seed
  bool searched = false;  // which steps were tried depended on times
  bool best = false;
  std::map<std::string, double> counters;
  std::map<std::string, double>
      errors;                   // max_strain, trajectory, energy_drift; those that are known
  std::vector<double> samples;  // wall seconds per simulated second

  bool ok() const { return status == "ok"; }
  std::string key() const { return sweep + " " + id; }
  std::string search() const { return key().substr(0, key().rfind("/h:")); }  // all but the step
};

struct ComparedResult {
  std::string path;
  nlohmann::json context;
  bool baseline = false;
  bool complete = true;
  std::vector<ComparedPoint> points;
};

// Result files of sweeps, or a baseline. Several files are one result: their contexts must agree in
// build and machine. Throws UsageError, naming the file, for anything else.
ComparedResult read_compared(const std::vector<std::string>& paths);
ComparedPoint compared_point(const nlohmann::json& point);  // of a result file or a baseline

// The baseline of result files, as read_result gives them.
nlohmann::ordered_json baseline_document(const std::vector<nlohmann::json>& results);

}  // namespace harness
