// References as files: their names, and JSON both ways.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "harness/judge/reference.h"

namespace harness {

// The file a reference of this scene is kept in: chain-n80.json, or with a hash of the parameters
// that are not the defaults. Duration does not count.
std::string reference_name(const std::string& scene, const SceneParameters& complete);

nlohmann::json to_json(const Reference& reference);
// A reference's document with this ensemble in place of its own, all else as it is.
nlohmann::json with_ensemble(nlohmann::json document, const Ensemble& ensemble);
// A row for each time, a number for each statistic.
nlohmann::json to_json(const ShapeSeries& series);
ShapeSeries shape_series_of(const nlohmann::json& rows);
// What a result file says of a reference that its errors were measured against.
nlohmann::json summary_of(const Reference& reference);
// Throws UsageError, naming the file, for anything that is not a reference.
Reference read_reference(const std::string& path);
// The same of its document; `path` is for messages.
Reference reference_of(const nlohmann::json& document, const std::string& path);

}  // namespace harness
