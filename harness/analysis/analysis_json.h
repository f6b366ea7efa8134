// The analysis of a result file as JSON, schema inextensible-analysis/1: `bench show --json`, and
// what figures are drawn from.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "harness/analysis/plane.h"

namespace harness::analysis {

nlohmann::json analysis_of(const Runs& runs);
// Its part "findings".
nlohmann::json findings_json(const std::vector<Plane>& planes);

}  // namespace harness::analysis
