// The result file, schema inextensible-bench/1 (configs/result.schema.json).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/points/point.h"
#include "harness/points/suite.h"

namespace harness {

// context: machine_context() as it was before the sweep ran. references:
// ReferenceFolder::summaries().
nlohmann::json result_document(nlohmann::json context, const Suite& suite,
                               const std::vector<std::string>& command, bool complete,
                               const std::vector<PointResult>& points,
                               nlohmann::json references = nlohmann::json::array());

// As it is written: one point a line.
std::string result_text(const nlohmann::json& document);

// false: it was made while others may have been timed, so its times mean nothing.
bool is_timed(const nlohmann::json& document);

// A document of either kind of result: of a sweep or of a stability sweep. Throws UsageError,
// naming the file, for anything else.
nlohmann::json read_result(const std::string& path);
nlohmann::json parse_result(const std::string& text, const std::string& path);
// The same of what is parsed already.
void check_result(const nlohmann::json& document, const std::string& path);
// A result of `bench answers`: schema inextensible-answers/1.
nlohmann::json read_answers(const std::string& path);
// Either of them, so that results/*.json may be given.
nlohmann::json read_result_or_answers(const std::string& path);
bool is_answers(const nlohmann::json& document);

// A result, and what messages and tables call it.
struct NamedResult {
  std::string name;
  nlohmann::json document;
};

}  // namespace harness
