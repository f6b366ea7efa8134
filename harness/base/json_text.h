// JSON as people read it: short values on one line, a list of points one a line.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace harness {

// As programs read it: without spaces. Text that is not UTF-8 (a path, a message from elsewhere)
// keeps what can be kept.
std::string compact(const nlohmann::json& value);

// On one line: {"a": 1, "b": [1, 2]}.
std::string line_of(const nlohmann::ordered_json& value);

// Everything that fits into `width` columns on one line, the rest an entry a line.
std::string folded_text(const nlohmann::ordered_json& value, std::size_t width = 120);

// A document for a repository, whose differences can be read: each entry of its objects and each
// item of its lists is one line.
std::string document_text(const nlohmann::ordered_json& document);

}  // namespace harness
