// Input from users: numbers within bounds, and JSON with // comments.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace harness {

using nlohmann::json;

// What a number must be, on the command line or in a file.
struct Bounds {
  static constexpr double huge = 1e300;  // as a bound: none

  double least = -huge;
  bool above = false;  // least itself is not allowed
  double most = huge;
  bool below = false;  // most itself is not allowed
  bool whole = false;

  static Bounds positive() { return {.least = 0, .above = true}; }
  // A strain limit: at 1 an edge may vanish.
  static Bounds strain() { return {.least = 0, .above = true, .most = 1, .below = true}; }
  // One that fits into an int.
  static Bounds whole_number(double least) {
    return {.least = least, .most = 2147483647, .whole = true};
  }
  // One that a double holds exactly, for seeds.
  static Bounds exact_number() { return {.least = 0, .most = 9007199254740992, .whole = true}; }
  std::string text() const;  // "a whole number of at least 2"
  bool hold(double number) const;
};

// JSON from outside, // comments or not. name: the file, or what else it is. Throws UsageError,
// naming it, if it is not JSON, has a key twice, or is nested deeper than our documents.
json parse_document(const std::string& text, const std::string& name);

// Throws UsageError, naming `path` and the first place that does not fit, unless `document` is as
// the JSON schema `rules` says. kind: of file, for the message.
void check_fits(const json& document, const json& rules, const std::string& kind,
                const std::string& path);

// A value for a message: short, whatever it is.
std::string value_text(const json& value);

// ---- JSON as people read it: short values on one line, a list of points one a line ----

// As programs read it: without spaces. Text that is not UTF-8 keeps what can be kept.
std::string compact(const json& value);

// A document for a repository: entries of its objects and items of its lists are a line each.
std::string document_text(const nlohmann::ordered_json& document);

}  // namespace harness
