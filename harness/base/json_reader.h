// Files that users write, in JSON with // comments: read strictly, with messages that name file,
// key and value.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "harness/base/bounds.h"

namespace harness {

// A JSON object whose keys are read one by one; finish() refuses keys that were not read. All throw
// UsageError.
class JsonReader {
 public:
  JsonReader(const nlohmann::json& object, std::string where);

  const nlohmann::json* find(const std::string& key);  // null if it is not there
  std::string text(const std::string& key, const std::string& otherwise);
  bool flag(const std::string& key, bool otherwise);
  double number(const std::string& key, double otherwise, const Bounds& bounds);
  std::vector<double> numbers(const std::string& key, const Bounds& bounds);
  std::vector<std::string> texts(const std::string& key);
  // One of `known`, or "did you mean"; `kind` is for the message.
  std::string one_of(const std::string& key, const std::string& otherwise,
                     const std::vector<std::string>& known, const std::string& kind);

  void finish() const;

  std::string where(const std::string& key) const { return where_ + ": '" + key + "'"; }
  [[noreturn]] void fail_at(const std::string& key, const nlohmann::json& value,
                            const std::string& wanted) const;

 private:
  double checked(const std::string& key, const nlohmann::json& value, const Bounds& bounds) const;
  const nlohmann::json& list(const std::string& key);

  const nlohmann::json& object_;
  std::string where_;
  std::set<std::string> known_;
};

// A text as JSON; with // comments where users write it themselves. Everything that comes from
// outside comes in here. Throws UsageError, naming the file, if it is none, if a key stands twice
// in an object, or if it is nested deeper than anything of ours.
nlohmann::json parse_document(const std::string& text, const std::string& path);
nlohmann::json parse_commented(const std::string& text, const std::string& path);
// The same of a text that is no file: `where` begins the message.
nlohmann::json parse_line(const std::string& text, const std::string& where);

// A value as it may stand in a message: short, whatever it is.
std::string value_text(const nlohmann::json& value);

}  // namespace harness
