// bench list: prints solvers, scenes, suites and other lists.
#include "harness/answers/answer.h"
#include "harness/claims/claims.h"
#include "harness/cli/command.h"
#include "harness/stability/hard_case.h"

namespace harness {
namespace {

struct List {
  std::string name;
  std::function<json()> rows;
};

template <class Items, class Row>
json rows_of(const Items& items, const Row& row) {
  json rows = json::array();
  for (const auto& item : items) rows.push_back(row(item));
  return rows;
}

template <class Items, class Row>
List list(const char* name, const Items& items, const Row& row) {
  return {name, [=] { return rows_of(items(), row); }};
}

json row_of(const std::string& name, const std::string& meaning, json row = json::object()) {
  row["name"] = name;
  row["meaning"] = meaning;
  return row;
}

json setting_row(const inextensible::SettingInfo& setting) {
  json row = row_of(setting.name, setting.meaning);
  std::visit([&row](const auto& value) { row["default"] = value; }, setting.initial);
  if (!setting.choices.empty()) row["choices"] = setting.choices;
  if (setting.tunable) row["tunable"] = {setting.tunable->least, setting.tunable->largest};
  return row;
}

json parameter_row(const SceneParameterInfo& parameter) {
  return row_of(parameter.name, parameter.meaning, {{"default", parameter.initial}});
}

json metrics() {
  json rows = json::array();
  for_each_field(std::tuple_cat(spec_fields, size_fields, measure_fields, sample_fields,
                                result_fields, phase_fields),
                 [&rows](const auto& field) {
                   rows.push_back(row_of(field.name, field.meaning, {{"unit", field.unit}}));
                 });
  return rows;
}

const std::vector<List> lists{
    list("solvers", backends,
         [](const Backend& b) {
           return json{{"name", b.name},
                       {"label", b.label},
                       {"summary", b.summary},
                       {"citation", b.citation},
                       {"method", b.method},
                       {"stepper", b.stepper},
                       {"contestant", b.contestant},
                       {"settings", rows_of(b.settings, setting_row)}};
         }),
    list("scenes", scene_types,
         [](const SceneType& type) {
           return json{{"name", type.name},
                       {"summary", type.summary},
                       {"resolution", type.resolution},
                       {"parameters", rows_of(type.parameters, parameter_row)}};
         }),
    list("suites", profiles,
         [](const std::string& name) {
           const Suite suite = read_suite(source_path("configs/" + name + ".json"));
           return json{{"name", name}, {"description", suite.description}};
         }),
    list("verbs", verbs, [](const Verb& verb) { return row_of(verb.name, verb.summary); }),
    list(
        "cases", [] { return hard_cases("paper"); },
        [](const HardCase& c) {
          return row_of(c.name, c.what, {{"row", c.row}});
        }),
    list("answers", known_answers,
         [](const KnownAnswer& answer) {
           return row_of(answer.name, answer.quantity + "; " + answer.source,
                         {{"scene", answer.scene}});
         }),
    list(
        "claims", [] { return judge_claims({}); },
        [](const ClaimVerdict& claim) {
          return row_of(claim.id, claim.statement, {{"where", claim.where}});
        }),
    list(
        "counters", [] { return std::span(inextensible::work_counters); },
        [](const auto& counter) {
          return row_of(counter.name, counter.meaning, {{"unit", counter.unit}});
        }),
    {"metrics", metrics},
    list(
        "statuses", [] { return std::span(point_statuses); },
        [](const auto& status) {
          return row_of(status.name, status.meaning, {{"letter", status.letter}});
        })};
constexpr int usual = 3;  // how many are printed if no list is named

std::string text_of(const json& row, const char* key) {
  const json value = row.value(key, json(""));
  return value.is_string() ? value.get<std::string>() : number_text(value.get<double>());
}

// "name (where): unit: meaning (letter in figures)", with settings or parameters below.
void print_rows(const json& rows) {
  for (const json& row : rows) {
    std::cout << "  " << text_of(row, "name");
    for (const char* key : {"row", "scene", "where"})
      if (row.contains(key)) std::cout << " (" << text_of(row, key) << ')';
    const std::string unit = text_of(row, "unit"), letter = text_of(row, "letter");
    std::cout << ": " << (unit.empty() ? "" : unit + ": ");
    for (const char* key : {"summary", "description", "meaning"}) std::cout << text_of(row, key);
    std::cout << (letter.empty() ? "" : " (" + letter + " in figures)") << '\n';
    for (const char* key : {"settings", "parameters"})
      for (const json& each : row.value(key, json::array()))
        std::cout << "      " << text_of(each, "name") << " = " << text_of(each, "default") << "  ("
                  << text_of(each, "meaning") << ")\n";
  }
}

struct MeshVerb : SceneOptions {
  std::string file;

  void declare(const Command& command) {
    command.option("file", file, "the mesh", "FILE.obj");
    command.require({"file"});
    SceneOptions::declare(command, "");
  }

  int run() {
    scene = "mesh:" + file;
    try {
      std::cout << find_scene(name())->description;
    } catch (const UnusableMesh& error) {
      std::cout << error.description << std::flush;
      if (!error.falls) throw;
      std::cout
          << "  a scene once it is held: --pins 'y > ...', --floor HEIGHT or --collider FILE\n";
    }
    return success;
  }
};

struct ListVerb {
  std::string what;
  bool as_json = false;

  void declare(const Command& command) {
    std::string names;
    for (const List& each : lists) append(names, each.name);
    command.option("what", what,
                   names +
                       "; default: the first three. result.schema and the like: that file of "
                       "configs/, generated from the tables in the code",
                   "WHAT");
    command.flag("--json", as_json, "as JSON");
  }

  void print_schema() const {
    const std::vector<std::string> schemas = generated_schemas();
    const std::string schema = what.substr(0, what.find(".schema"));
    if (schema == what || std::ranges::count(schemas, schema) == 0)
      throw unknown_name("list", what, names_of(lists));
    if (as_json) throw UsageError("--json does not go with list " + what);
    std::cout << schema_text(schema);
  }

  int run() {
    std::vector<List> chosen(lists.begin(), what.empty() ? lists.begin() + usual : lists.end());
    if (!what.empty())
      std::erase_if(chosen, [this](const List& each) { return each.name != what; });
    if (chosen.empty()) print_schema();
    json all = json::object();
    for (const List& each : chosen) {
      all[each.name] = each.rows();
      if (as_json) continue;
      if (what.empty()) std::cout << (all.size() == 1 ? "" : "\n") << each.name << '\n';
      print_rows(all[each.name]);
    }
    if (as_json) std::cout << document_text(what.empty() ? all : all[what]);
    return success;
  }
};

}  // namespace

Action mesh_verb(const Command& command) { return verb<MeshVerb>(command); }
Action list_verb(const Command& command) { return verb<ListVerb>(command); }

}  // namespace harness
