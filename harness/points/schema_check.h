// Documents from outside against the schemas in configs, as the tables of fields make them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace harness {

// Throws UsageError, naming `path` and the first place that does not fit, unless `document` is as
// configs/<schema>.schema.json says.
void check_schema(const nlohmann::json& document, const std::string& schema,
                  const std::string& path);

}  // namespace harness
