#include "harness/points/schema.h"

#include "harness/base/files.h"
#include "harness/points/suite.h"

namespace harness {
namespace {

using nlohmann::ordered_json;

const char* word_of(inextensible::Origin origin) {
  constexpr std::array words{"paper", "project", "literature", "engine", "elsewhere"};
  return words.at(static_cast<std::size_t>(origin));
}

ordered_json closed_object() {
  return {{"type", "object"},
          {"required", ordered_json::array()},
          {"additionalProperties", false},
          {"properties", ordered_json::object()}};
}

void add(ordered_json& object, const char* name, ordered_json schema, bool required = true) {
  object["properties"][name] = std::move(schema);
  ordered_json& names = object["required"];
  if (required && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

template <class Table>
void add_fields(ordered_json& object, const Table& table) {
  for_each_field(table, [&object](const auto& row) {
    using Value = typename std::decay_t<decltype(row)>::Type;
    ordered_json schema = FieldCodec<Value>::schema(row.traits);
    schema["description"] = described(row);
    const char* inside = row.traits.inside;
    const bool required = !row.traits.nullable;  // others may be absent, as null
    if (!*inside) return add(object, row.name, schema, required);
    if (inside == std::string("work")) return;  // work_schema's
    if (!object["properties"].contains(inside)) add(object, inside, closed_object());
    add(object["properties"][inside], row.name, schema, required);
  });
}

ordered_json work_schema() {
  ordered_json work = closed_object();
  for (const auto& counter : inextensible::work_counters) {
    const bool whole = counter.member.index() == 0;
    add(work, counter.name,
        {{"type", whole ? "integer" : "number"},
         {"minimum", 0},
         {"description", described(counter)}});
  }
  for_each_field(result_fields, [&work](const auto& row) {
    if (row.traits.inside == std::string("work"))
      add(work, row.name, {{"type", "integer"}, {"minimum", 0}, {"description", described(row)}});
  });
  return work;
}

// What no table has, such as what is written for readers, stays as it is.
ordered_json point_schema(ordered_json point) {
  add_fields(point, sample_fields);
  const PointResult any;
  for_each_table(any, [&point](const auto& table, const auto&) { add_fields(point, table); });
  point["properties"]["sweep"] = {{"enum", sweep_kinds()}};
  point["properties"]["scene_parameters"].update(
      {{"additionalProperties", {{"type", "number"}}}, {"required", {"duration"}}});
  return point;
}

ordered_json schema_document(const std::string& name) {
  const std::string path = source_path("configs/" + name + ".schema.json");
  ordered_json schema = ordered_json::parse(read_file(path, "schema"));
  if (!schema.contains("definitions")) return schema;
  ordered_json& definitions = schema["definitions"];
  const auto renew = [&definitions](const char* part, auto made) {
    if (definitions.contains(part)) definitions[part] = made();
  };
  renew("status", [] { return ordered_json{{"enum", names_of(point_statuses)}}; });
  renew("counter", [] { return ordered_json{{"enum", counter_names()}}; });
  renew("work", work_schema);
  renew("point", [&definitions] { return point_schema(definitions["point"]); });
  renew("answer_row", [] {
    ordered_json row = closed_object();
    add_fields(row, answer_row_fields);
    return row;
  });
  return schema;
}

}  // namespace

std::vector<std::string> generated_schemas() {
  return {"result", "baseline", "gate", "stability", "tuned", "answers"};
}

std::string schema_text(const std::string& name) { return schema_document(name).dump(2) + "\n"; }

ordered_json legend(const Contestants& contestants) {
  ordered_json solvers = ordered_json::array(), statuses = ordered_json::array();
  const auto entry = [](const Backend& backend, const std::string& name, const std::string& label) {
    return ordered_json{{"name", name},
                        {"label", label},
                        {"family", backend.family},
                        {"method", backend.method},
                        {"stepper", backend.stepper},
                        {"origin", word_of(backend.origin)},
                        {"stepper_origin", word_of(backend.stepper_origin)},
                        {"contestant", backend.contestant}};
  };
  for (const auto& backend : backends()) {
    solvers.push_back(entry(backend, backend.name, backend.label));
    for (const Contestant& c : contestants) {
      if (c.own_name() || c.solver != backend.name) continue;
      ordered_json more = entry(backend, c.name, label_of(c));
      more["solver"] = c.solver;
      more["unranked"] = c.unranked;
      solvers.push_back(std::move(more));
    }
  }
  for (const auto& row : point_statuses)
    statuses.push_back({{"name", row.name}, {"letter", row.letter}, {"meaning", row.meaning}});
  return {{"solvers", solvers}, {"statuses", statuses}};
}

std::vector<std::string> counter_names() { return work_schema().at("required"); }

void check_schema(const json& document, const std::string& schema, const std::string& path) {
  check_fits(document, schema_document(schema), schema, path);
}

}  // namespace harness
