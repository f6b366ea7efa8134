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
// What a result file says of a reference that its errors were measured against.
nlohmann::json summary_of(const Reference& reference);
// Throws UsageError, naming the file, for anything that is not a reference.
Reference read_reference(const std::string& path);

}  // namespace harness
