#include "harness/points/schema_check.h"

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/points/schema.h"

namespace harness {

using nlohmann::json;

void check_schema(const json& document, const std::string& schema, const std::string& path) {
  const json rules = schema_document(schema);
  const valijson::adapters::NlohmannJsonAdapter rules_adapter(rules), adapter(document);
  valijson::Schema parsed;
  valijson::SchemaParser().populateSchema(rules_adapter, parsed);
  valijson::ValidationResults results;
  if (valijson::Validator().validate(parsed, adapter, &results)) return;
  // The errors come from the inside out: the first one is the place itself.
  valijson::ValidationResults::Error error;
  std::string place, what = "does not fit its schema";
  if (results.popError(error)) {
    for (const std::string& step : error.context) place += step == "<root>" ? "" : step;
    what = error.description;
  }
  throw UsageError("'" + path + "' is not a " + schema + " file: at " +
                   (place.empty() ? "its top" : shortened(place, 100)) + ": " +
                   shortened(what, 200));
}

}  // namespace harness
