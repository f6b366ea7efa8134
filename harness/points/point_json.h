// A point as JSON: in result files, in journals, and between a child process and its parent.
#pragma once

#include <nlohmann/json.hpp>

#include "harness/base/fields.h"
#include "harness/points/point.h"

namespace harness {

nlohmann::json to_json(const inextensible::Settings& settings);
nlohmann::json to_json(const inextensible::WorkCounters& work);
nlohmann::json to_json(const PointResult& point);
nlohmann::json to_json(const Repetition& repetition);

// The way back: to_json(point_of(j)) == j. All throw json::exception for anything that is not what
// they read.
inextensible::WorkCounters work_of(const nlohmann::json& work);
PointResult point_of(const nlohmann::json& point);
Repetition repetition_of(const nlohmann::json& repetition);
PointSpec spec_of(const nlohmann::json& point);

// All of a point that is not measured: two runs of one key may stand for each other.
std::string key_of(const PointSpec& spec);

}  // namespace harness
