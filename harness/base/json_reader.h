// Files that users write, in JSON with // comments: read strictly, with messages that name file,
// key and value.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace harness {

// What a number must be.
struct Bounds {
  double least = -1e300;
  bool above = false;  // least itself is not allowed
  double most = 1e300;
  bool whole = false;

  static Bounds positive() { return {.least = 0, .above = true}; }
  static Bounds at_least(double least) { return {.least = least}; }
  static Bounds whole_number(double least) { return {.least = least, .whole = true}; }
  std::string text() const;  // "a whole number of at least 2"
  bool hold(double number) const;
};

// A JSON object whose keys are read one by one; finish() refuses what nobody asked for. All throw
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

// A text as JSON with comments; throws UsageError, naming the file, if it is none.
nlohmann::json parse_commented(const std::string& text, const std::string& path);

}  // namespace harness
