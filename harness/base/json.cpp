#define VALIJSON_USE_EXCEPTIONS 1  // here alone: for all, it would forbid the precompiled header
#include "harness/base/json.h"

#include <cmath>
#include <set>
#include <tuple>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "harness/base/text.h"

namespace harness {

using nlohmann::ordered_json;

namespace {

template <class Json>
std::string written(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// The entries of `depth` levels a line each.
std::string lines(const ordered_json& value, int depth) {
  if (!value.is_structured()) return written(value);
  const std::string end = depth > 0 && !value.empty() ? "\n" : "";
  std::string text, between = end;
  for (const auto& [key, item] : value.items()) {
    text += between + (value.is_object() ? written(ordered_json(key)) + ": " : "") +
            lines(item, depth - 1);
    between = "," + (end.empty() ? " " : end);
  }
  return (value.is_object() ? "{" : "[") + text + end + (value.is_object() ? "}" : "]");
}

// The keys of all objects that a schema describes.
void add_keys(const json& rules, std::vector<std::string>& keys) {
  for (const auto& [name, rule] : rules.items()) {
    for (const auto& property : rule.items())
      if (name == "properties") keys.push_back(property.key());
    if (rule.is_structured()) add_keys(rule, keys);
  }
}

}  // namespace

std::string Bounds::text() const {
  const auto words = [this](const char* relation, double bound) {
    return relation + number_text(bound, whole ? 16 : 6);
  };
  return (whole ? "a whole number" : "a number") +
         (least > -huge ? words(above ? " above " : " of at least ", least) : "") +
         (least > -huge && most < huge ? " and" : "") +
         (most < huge ? words(below ? " below " : " at most ", most) : "");
}

bool Bounds::hold(double number) const {
  return std::isfinite(number) && (above ? number > least : number >= least) &&
         (below ? number < most : number <= most) && (!whole || number == std::floor(number));
}

// Looks at the text first: trees are parsed by recursion, and keep the last of two equal keys.
json parse_document(const std::string& text, const std::string& name) {
  constexpr std::size_t deepest = 64;  // ours are less than ten deep
  const std::string refusal = "'" + name + "' is not JSON: ";
  std::vector<std::set<std::string>> keys;  // of the objects that are open, by depth
  const auto inspect = [&](int depth, json::parse_event_t event, const json& value) {
    using Event = json::parse_event_t;
    const auto at = static_cast<std::size_t>(depth);
    if ((event == Event::object_start || event == Event::array_start) && at >= deepest)
      throw UsageError(refusal + "it is nested more than " + std::to_string(deepest) + " deep");
    if (event == Event::object_start) {
      keys.resize(at);
      keys.emplace_back();
    } else if (event == Event::key && !keys.at(at - 1).insert(value.get<std::string>()).second) {
      throw UsageError(refusal + "the key '" + shortened(value.get<std::string>(), 40) +
                       "' occurs twice in an object");
    }
    return false;  // nothing is kept
  };
  try {
    std::ignore = json::parse(text, inspect, true, true);
    return json::parse(text, nullptr, true, true);
  } catch (const json::exception& error) {
    throw UsageError(refusal + shortened(error.what()));
  }
}

std::string value_text(const json& value) {
  // A large value is named by its kind only: printing it may take as long as reading it.
  if (value.is_structured() && value.size() > 8)
    return std::string(value.is_array() ? "a list" : "an object") + " of " +
           std::to_string(value.size());
  return shortened(compact(value), 60);
}

std::string compact(const json& value) { return written(value); }

std::string document_text(const ordered_json& document) { return lines(document, 2) + "\n"; }

void check_fits(const json& document, const json& rules, const std::string& kind,
                const std::string& path) {
  const valijson::adapters::NlohmannJsonAdapter rules_adapter(rules), adapter(document);
  valijson::Schema parsed;
  valijson::SchemaParser().populateSchema(rules_adapter, parsed);
  valijson::ValidationResults results;
  if (valijson::Validator().validate(parsed, adapter, &results)) return;
  // The errors come from the inside out: the first one is the place itself.
  valijson::ValidationResults::Error error;
  results.popError(error);
  std::string place;
  json::json_pointer pointer;
  for (const std::string& step : error.context) {
    if (step == "<root>") continue;
    place += step;
    pointer /= step.substr(1, step.size() - 2);  // [key] or [index]
  }
  const bool plain = document.contains(pointer) && document.at(pointer).is_primitive();
  std::string what = error.description;
  if (what.starts_with("Object contains a property")) {
    const auto begin = what.rfind(": '") + 3;
    const std::string key = what.substr(begin, what.rfind('\'') - begin);
    std::vector<std::string> keys;
    add_keys(rules, keys);
    std::erase(keys, key);  // known elsewhere
    const std::string near = closest(key, keys);
    what = "unknown key '" + key + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?");
  }
  throw UsageError("'" + path + "' is not a " + kind + " file: at " +
                   (place.empty() ? "its top" : shortened(place, 100)) +
                   (plain ? ", " + value_text(document.at(pointer)) : "") + ": " +
                   shortened(what, 200));
}

}  // namespace harness
