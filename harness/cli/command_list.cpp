// bench list: what there is.
#include <algorithm>
#include <iostream>

#include "harness/answers/answer.h"
#include "harness/base/errors.h"
#include "harness/base/json_text.h"
#include "harness/base/paths.h"
#include "harness/claims/claims.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/sweep_options.h"
#include "harness/cli/verbs.h"
#include "harness/points/point_fields.h"
#include "harness/points/schema.h"
#include "harness/stability/hard_case.h"

namespace harness {
namespace {

using nlohmann::json;

json list_row(const std::string& name, const std::string& meaning) {
  return {{"name", name}, {"meaning", meaning}};
}

template <class Field>
json field_row(const Field& field) {
  json fields = list_row(field.name, field.meaning);
  fields["unit"] = field.unit;
  return fields;
}

template <class Backend>
json settings_json(const Backend& backend) {
  json settings = json::array();
  for (const auto& setting : backend.settings) {
    json fields = list_row(setting.name, setting.meaning);
    std::visit([&fields](const auto& value) { fields["default"] = value; }, setting.initial);
    if (!setting.choices.empty()) fields["choices"] = setting.choices;
    if (setting.tunable) fields["tunable"] = {setting.tunable->least, setting.tunable->largest};
    settings.push_back(std::move(fields));
  }
  return settings;
}

json solvers_json() {
  json list = json::array();
  for (const auto& backend : inextensible::backends()) {
    list.push_back({{"name", backend.name},
                    {"label", backend.label},
                    {"summary", backend.summary},
                    {"citation", backend.citation},
                    {"method", backend.method},
                    {"stepper", backend.stepper},
                    {"contestant", backend.contestant},
                    {"settings", settings_json(backend)}});
  }
  return list;
}

json scenes_json() {
  json list = json::array();
  for (const auto& type : scene_types()) {
    json parameters = json::array();
    for (const auto& parameter : type.parameters) {
      json fields = list_row(parameter.name, parameter.meaning);
      fields["default"] = parameter.initial;
      parameters.push_back(std::move(fields));
    }
    list.push_back({{"name", type.name},
                    {"summary", type.summary},
                    {"resolution", type.resolution},
                    {"parameters", parameters}});
  }
  return list;
}

json suites_json() {
  json list = json::array();
  for (const std::string& name : profiles()) {
    const Suite suite = read_suite(source_path("configs/" + name + ".json"));
    list.push_back({{"name", name}, {"description", suite.description}});
  }
  return list;
}

json verbs_json() {
  json list = json::array();
  for (const Verb& verb : verbs()) list.push_back(list_row(verb.name, verb.summary));
  return list;
}

json counters_json() {
  json list = json::array();
  for (const auto& counter : inextensible::work_counters) list.push_back(field_row(counter));
  return list;
}

json metrics_json() {
  json list = json::array();
  const auto add = [&list](const auto& table) {
    for_each_field(table, [&list](const auto& each) { list.push_back(field_row(each)); });
  };
  add(spec_fields);
  add(size_fields);
  add(measure_fields);
  add(result_fields);
  add(phase_fields);
  return list;
}

json statuses_json() {
  json list = json::array();
  for (const auto& status : point_statuses) {
    list.push_back(list_row(status.name, status.meaning));
    list.back()["letter"] = status.letter;
  }
  return list;
}

json cases_json() {
  json list = json::array();
  for (const HardCase& c : hard_cases(hard_case_values("paper"))) {
    list.push_back(list_row(c.name, c.what));
    list.back()["row"] = c.row;
  }
  return list;
}

json answers_json() {
  json list = json::array();
  for (const KnownAnswer& answer : known_answers()) {
    list.push_back(list_row(answer.name, std::string(answer.quantity) + "; " + answer.source));
    list.back()["scene"] = answer.scene;
  }
  return list;
}

json claims_json() {
  json list = json::array();
  for (const ClaimVerdict& claim : judge_claims({})) {
    list.push_back(list_row(claim.id, claim.statement));
    list.back()["where"] = claim.where;
  }
  return list;
}

struct List {
  const char* name;
  json (*rows)();
};
constexpr List lists[] = {
    {"solvers", solvers_json},   {"scenes", scenes_json},     {"suites", suites_json},
    {"verbs", verbs_json},       {"cases", cases_json},       {"answers", answers_json},
    {"claims", claims_json},     {"counters", counters_json}, {"metrics", metrics_json},
    {"statuses", statuses_json},
};
constexpr std::size_t usual = 3;  // of them, if no list is named

std::string list_names() {
  std::string names;
  for (const List& each : lists) names += std::string(each.name) + ", ";
  return names + "points";
}

std::string text_of(const json& row, const char* key) {
  return row.contains(key) ? row.at(key).get<std::string>() : std::string();
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
    for (const char* key : {"settings", "parameters"}) {
      if (!row.contains(key)) continue;
      for (const json& each : row.at(key)) {
        const json& value = each.at("default");
        std::cout << "      " << text_of(each, "name") << " = ";
        if (value.is_string()) {
          std::cout << value.get<std::string>();
        } else {
          std::cout << value.get<double>();
        }
        std::cout << "  (" << text_of(each, "meaning") << ")\n";
      }
    }
  }
}

void print_lists(const std::string& what, bool as_json) {
  json all = json::object();
  for (std::size_t i = 0; i < std::size(lists); ++i) {
    const auto& [name, rows] = lists[i];
    if (what.empty() ? i >= usual : what != name) continue;
    if (as_json) {
      all[name] = rows();
      continue;
    }
    if (what.empty()) std::cout << (i == 0 ? "" : "\n") << name << '\n';
    print_rows(rows());
  }
  if (as_json) std::cout << document_text(what.empty() ? all : all.at(what));
}

void list_points(const SweepOptions& options) {
  for (const Search& search : plan(load_suite(options), make_filters(options))) {
    PointSpec spec = search.base;
    for (const double step : search.ladder) {
      spec.step = step;
      std::cout << spec.id() << '\n';
    }
  }
}

// result.schema and its like: such a file of configs/, with what follows from tables.
bool print_schema(const std::string& what) {
  const std::vector<std::string> schemas = generated_schemas();
  const auto dot = what.find(".schema");
  if (dot == std::string::npos ||
      std::find(schemas.begin(), schemas.end(), what.substr(0, dot)) == schemas.end())
    return false;
  std::cout << schema_text(what.substr(0, dot));
  return true;
}

struct ListOptions {
  SweepOptions points;
  std::string what;
  bool as_json = false;
};

int run_list(const ListOptions& given) {
  std::vector<std::string> known;
  for (const List& each : lists) known.emplace_back(each.name);
  if (given.what.empty() || std::find(known.begin(), known.end(), given.what) != known.end()) {
    print_lists(given.what, given.as_json);
    return success;
  }
  if (given.as_json) throw UsageError("--json does not go with list " + given.what);
  if (given.what == "points") {
    list_points(given.points);
  } else if (!print_schema(given.what)) {
    known.emplace_back("points");
    throw unknown_name("list", given.what, known);
  }
  return success;
}

}  // namespace

Verb list_verb() {
  return {"list", "print what there is: " + list_names(), [](const Command& command) -> Action {
            const auto given = std::make_shared<ListOptions>();
            command.option("what", given->what,
                           list_names() +
                               " (with --sweep); default: the first three. result.schema and the "
                               "like: that file of configs/, generated from the tables in the code",
                           "WHAT");
            add_selection(command, given->points);
            command.flag("--json", given->as_json, "as JSON");
            return [given] { return run_list(*given); };
          }};
}

}  // namespace harness
