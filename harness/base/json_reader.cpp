#include "harness/base/json_reader.h"

#include <algorithm>
#include <cmath>

#include "harness/base/errors.h"
#include "harness/base/text.h"

namespace harness {

using nlohmann::json;

std::string Bounds::text() const {
  std::string words = whole ? "a whole number" : "a number";
  if (least > -1e300) words += (above ? " above " : " of at least ") + number_text(least);
  if (most < 1e300) words += (least > -1e300 ? " and" : "") + (" at most " + number_text(most));
  return words;
}

bool Bounds::hold(double number) const {
  return std::isfinite(number) && (above ? number > least : number >= least) && number <= most &&
         (!whole || number == std::floor(number));
}

JsonReader::JsonReader(const json& object, std::string where)
    : object_(object), where_(std::move(where)) {
  if (!object.is_object())
    throw UsageError(where_ + " is " + object.dump() + ", must be an object { ... }");
}

const json* JsonReader::find(const std::string& key) {
  known_.insert(key);
  const auto place = object_.find(key);
  return place == object_.end() ? nullptr : &*place;
}

std::string JsonReader::text(const std::string& key, const std::string& otherwise) {
  const json* value = find(key);
  if (!value) return otherwise;
  if (!value->is_string()) fail_at(key, *value, "a text in quotes");
  return value->get<std::string>();
}

bool JsonReader::flag(const std::string& key, bool otherwise) {
  const json* value = find(key);
  if (!value) return otherwise;
  if (!value->is_boolean()) fail_at(key, *value, "true or false");
  return value->get<bool>();
}

double JsonReader::number(const std::string& key, double otherwise, const Bounds& bounds) {
  const json* value = find(key);
  return value ? checked(key, *value, bounds) : otherwise;
}

std::vector<double> JsonReader::numbers(const std::string& key, const Bounds& bounds) {
  std::vector<double> result;
  for (const json& item : list(key)) result.push_back(checked(key, item, bounds));
  return result;
}

std::vector<std::string> JsonReader::texts(const std::string& key) {
  std::vector<std::string> result;
  for (const json& item : list(key)) {
    if (!item.is_string()) fail_at(key, item, "a list of texts");
    result.push_back(item.get<std::string>());
  }
  return result;
}

std::string JsonReader::one_of(const std::string& key, const std::string& otherwise,
                               const std::vector<std::string>& known, const std::string& kind) {
  const json* value = find(key);
  if (!value) return otherwise;
  std::string name = value->is_string() ? value->get<std::string>() : value->dump();
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw UsageError(where(key) + ": " + unknown_name(kind, name, known).what());
  return name;
}

void JsonReader::finish() const {
  const std::vector<std::string> known(known_.begin(), known_.end());
  for (const auto& [key, value] : object_.items()) {
    if (!known_.contains(key))
      throw UsageError(where_ + ": " + unknown_name("key", key, known).what());
  }
}

void JsonReader::fail_at(const std::string& key, const json& value,
                         const std::string& wanted) const {
  throw UsageError(where(key) + " is " + value.dump() + ", must be " + wanted);
}

double JsonReader::checked(const std::string& key, const json& value, const Bounds& bounds) const {
  if (!value.is_number() || !bounds.hold(value.get<double>())) fail_at(key, value, bounds.text());
  return value.get<double>();
}

const json& JsonReader::list(const std::string& key) {
  static const json none = json::array();
  const json* value = find(key);
  if (!value) return none;
  if (!value->is_array() || value->empty())
    fail_at(key, *value, "a list [ ... ] that is not empty");
  return *value;
}

json parse_commented(const std::string& text, const std::string& path) {
  try {
    return json::parse(text, nullptr, true, /*ignore_comments=*/true);
  } catch (const json::exception& error) {
    throw UsageError("'" + path + "' is not JSON: " + error.what());
  }
}

}  // namespace harness
