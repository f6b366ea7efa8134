// A struct's fields as they stand in files: each said once, in a table beside the struct. JSON both
// ways, schemas, `bench list` and the tests that fill structs at random follow from the table.
#pragma once

#include <string>
#include <tuple>

namespace harness {

struct FieldTraits {
  const char* inside = "";  // the nested object of the file that holds it
  bool nullable = false;    // may be null or absent in files: an unknown number, an empty text
  bool positive = false;    // a number above 0, not merely of at least 0
};

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

}  // namespace harness
