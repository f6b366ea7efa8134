// A struct's fields as they appear in files, each listed once in a table beside the struct. JSON
// in both directions, schemas, `bench list` and the tests with random structs use the table.
#pragma once

#include <cmath>
#include <limits>
#include <tuple>

#include "harness/base/json.h"

namespace harness {

struct FieldTraits {
  const char* inside = "";  // the nested object of the file that holds it
  bool nullable = false;    // may be null or absent in files: an unknown number, an empty text
  bool positive = false;    // a number above 0, not merely of at least 0
};
inline constexpr FieldTraits may_be_absent{.nullable = true};

template <class Object, class Value>
struct Field {
  using Type = Value;
  const char* name;
  Value Object::*member;
  const char* unit;  // "" of a pure number, a text, an object
  const char* meaning;
  FieldTraits traits;
};

template <class Object, class Value>
constexpr Field<Object, Value> field(const char* name, Value Object::*member, const char* unit,
                                     const char* meaning, FieldTraits traits = {}) {
  return {name, member, unit, meaning, traits};
}

template <class Table, class Visit>
constexpr void for_each_field(const Table& table, Visit&& visit) {
  std::apply([&visit](const auto&... each) { (visit(each), ...); }, table);
}

// "m/s: how fast"; of a pure number the meaning alone.
template <class Row>
std::string described(const Row& row) {
  return (*row.unit ? std::string(row.unit) + ": " : std::string()) + row.meaning;
}

// null for a number that is not finite, which JSON cannot express.
inline json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }
inline double number_of(const json& value) {  // NaN for null
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

// How a type is written as JSON, and its schema. Types that JSON does not have specialize it.
template <class Value>
struct FieldCodec {
  static json write(const Value& value, bool nullable) {
    if constexpr (std::is_same_v<Value, double>) return number(value);
    if constexpr (std::is_same_v<Value, std::string>)
      if (nullable && value.empty()) return nullptr;
    return value;
  }

  static void read(const json& from, Value& value, bool nullable) {
    if constexpr (std::is_same_v<Value, double>)
      value = nullable ? number_of(from) : from.get<double>();
    else if (nullable && from.is_null())
      value = {};
    else
      from.get_to(value);
  }

  static nlohmann::ordered_json schema(const FieldTraits& traits) {
    const auto type = [&traits](const char* name) {
      return traits.nullable ? nlohmann::ordered_json{{"type", {name, "null"}}}
                             : nlohmann::ordered_json{{"type", name}};
    };
    if constexpr (std::is_same_v<Value, bool>) return type("boolean");
    if constexpr (std::is_same_v<Value, std::string>) return type("string");
    if constexpr (!std::is_arithmetic_v<Value>) return type("object");
    nlohmann::ordered_json schema = type(std::is_integral_v<Value> ? "integer" : "number");
    if (!traits.nullable) schema[traits.positive ? "exclusiveMinimum" : "minimum"] = 0;
    return schema;
  }
};

template <class Json, class Table, class Object>
void write_fields(Json& to, const Table& table, const Object& object) {
  for_each_field(table, [&](const auto& row) {
    using Value = typename std::decay_t<decltype(row)>::Type;
    Json& place = *row.traits.inside ? to[row.traits.inside] : to;
    place[row.name] = FieldCodec<Value>::write(object.*row.member, row.traits.nullable);
  });
}

// Throws json::exception where a field is missing or of another type.
template <class Table, class Object>
void read_fields(const json& from, const Table& table, Object& object) {
  for_each_field(table, [&](const auto& row) {
    using Value = typename std::decay_t<decltype(row)>::Type;
    const json& place = *row.traits.inside ? from.at(row.traits.inside) : from;
    if (row.traits.nullable && !place.contains(row.name)) return;  // as null
    FieldCodec<Value>::read(place.at(row.name), object.*row.member, row.traits.nullable);
  });
}

}  // namespace harness
