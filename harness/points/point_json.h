// A point as JSON: in result files, in journals, and between a child process and its parent.
#pragma once

#include <nlohmann/json.hpp>

#include "harness/points/point.h"

namespace harness {

// null for a number that is not finite: JSON has no word for it.
nlohmann::json number(double value);
double number_of(const nlohmann::json& value);  // NaN for null
nlohmann::json to_json(const inextensible::WorkCounters& work);
nlohmann::json to_json(const PointResult& point);
inextensible::WorkCounters work_of(const nlohmann::json& work);

// The way back: to_json(point_of(j)) == j. Both throw json::exception for anything that is not a
// point.
PointResult point_of(const nlohmann::json& point);
PointSpec spec_of(const nlohmann::json& point);

}  // namespace harness
