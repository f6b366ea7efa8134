// Documents corrupted at random, repeatably: as texts, or value by value, so that they stay JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

namespace harness::testing {

// One to four corrupted places: bytes changed, cut out, doubled or put in from a list of nuisances.
inline std::string corrupt_text(std::string text, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return random() % n; };
  static const std::vector<std::string> nuisances{
      "null",   "-1",  "1e999",   "0",      "\"\"",
      "[]",     "{}",  "true",    "1e-320", "18446744073709551616",
      "[[[[",   "}}}", "\\u0000", ",",      ":",
      "\"\xff", "//",  "/*",      "NaN",    "2147483648"};
  for (std::size_t i = 1 + below(4); i > 0 && !text.empty(); --i) {
    const std::size_t at = below(text.size());
    const std::size_t kind = below(5);
    if (kind == 0) text[at] = static_cast<char>(random());
    if (kind == 1) text.erase(at, 1 + below(20));
    if (kind == 2) text.insert(at, text.substr(below(text.size()), 1 + below(40)));
    if (kind == 3) text.insert(at, nuisances[below(nuisances.size())]);
    if (kind < 4) continue;
    const std::size_t colon = text.find(':', at), end = text.find_first_of(",}\n", colon);
    if (end != std::string::npos)  // a whole value
      text.replace(colon + 1, end - colon - 1, nuisances[below(nuisances.size())]);
  }
  return text;
}

// A value somewhere in the tree.
inline nlohmann::json& some_value(nlohmann::json& document, std::mt19937_64& random) {
  nlohmann::json* place = &document;
  while (place->is_structured() && !place->empty() && random() % 8 != 0) {
    auto item = place->begin();
    std::advance(item, static_cast<std::ptrdiff_t>(random() % place->size()));
    place = &*item;
  }
  return *place;
}

// One to three values that are another's, gone, or of another kind or size.
inline std::string corrupt_values(nlohmann::json document, std::mt19937_64& random) {
  using nlohmann::json;
  static const std::vector<json> nuisances = json::parse(
      R"([null, true, -1, 0, 1, 2, 1e-320, 1e308, -1e308, 1e-9, 2147483648.0, 1.5, "", "x", "../x",
          "a\nb", [], {}, [1, 2, 3], {"a": 1}, 18446744073709551615, -9223372036854775807, ")" +
      std::string(5000, 'y') + "\"]");
  for (std::size_t i = 1 + random() % 3; i > 0; --i) {
    json& value = some_value(document, random);
    switch (random() % 5) {
      case 0: {
        const json copy = some_value(document, random);
        some_value(document, random) = copy;
        break;
      }
      case 1:
        if (value.is_structured() && !value.empty()) {
          auto item = value.begin();
          std::advance(item, static_cast<std::ptrdiff_t>(random() % value.size()));
          value.erase(item);
        }
        break;
      case 2:
        if (value.is_object()) value["no_such_key"] = 1;
        if (value.is_array() && !value.empty()) value.push_back(value.front());
        if (value.is_number()) value = -value.get<double>();
        if (value.is_string()) value = value.get<std::string>() + "x";
        break;
      default:
        value = nuisances[random() % nuisances.size()];
    }
  }
  return document.dump();
}

inline std::string corrupt(const std::string& text, std::mt19937_64& random) {
  if (random() % 2 == 0) return corrupt_text(text, random);
  nlohmann::json document = nlohmann::json::parse(text, nullptr, false, true);
  if (document.is_discarded()) return corrupt_text(text, random);  // journals: a document a line
  return corrupt_values(std::move(document), random);
}

}  // namespace harness::testing
