// Schemas of files: what the tables of fields say is put into their definitions, the rest is
// written by hand.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/points/contestant.h"

namespace harness {

// The schema with those of its definitions replaced that follow from tables: "status", "counter",
// "work", "point", "answer_row".
nlohmann::ordered_json with_tables(nlohmann::ordered_json schema);

// configs/<name>.schema.json, with_tables.
nlohmann::ordered_json schema_document(const std::string& name);
// As it is to stand in configs/<name>.schema.json; "result", "baseline", "gate", "stability",
// "tuned", "answers".
std::string schema_text(const std::string& name);
std::vector<std::string> generated_schemas();

// Names and meanings that figures show: of all registered solvers, each followed by contestants
// that are it under another name, and of statuses.
nlohmann::ordered_json legend(const Contestants& contestants = {});

// Schema of `work` in a result file.
std::vector<std::string> counter_names();

// Throws UsageError, naming `path` and the first place that does not fit, unless `document` is as
// configs/<schema>.schema.json says.
void check_schema(const nlohmann::json& document, const std::string& schema,
                  const std::string& path);

}  // namespace harness
