// bench list: what there is.
#include <iostream>

#include "harness/answers/answer.h"
#include "harness/base/errors.h"
#include "harness/base/json_text.h"
#include "harness/base/paths.h"
#include "harness/cli/commands.h"
#include "harness/cli/sweep_options.h"
#include "harness/points/point_fields.h"
#include "harness/points/schema.h"
#include "harness/stability/hard_case.h"

namespace harness {
namespace {

using nlohmann::json;

void list(const std::string& what) {
  const auto heading = [&](const char* name) {
    if (what.empty()) std::cout << (name == std::string("solvers") ? "" : "\n") << name << '\n';
    return what.empty() || what == name;
  };
  if (heading("solvers")) {
    for (const auto& backend : inextensible::backends()) {
      std::cout << "  " << backend.name << ": " << backend.summary << '\n';
      for (const auto& setting : backend.settings) {
        std::cout << "      " << setting.name << " = ";
        std::visit([](const auto& value) { std::cout << value; }, setting.initial);
        std::cout << "  (" << setting.meaning << ")\n";
      }
    }
  }
  if (heading("scenes")) {
    for (const auto& type : scene_types()) {
      std::cout << "  " << type.name << ": " << type.summary << '\n';
      for (const auto& parameter : type.parameters) {
        std::cout << "      " << parameter.name << " = " << parameter.initial << "  ("
                  << parameter.meaning << ")\n";
      }
    }
  }
  const auto row = [](const char* name, const std::string& meaning) {
    std::cout << "  " << name << ": " << meaning << '\n';
  };
  if (what == "counters") {
    for (const auto& counter : inextensible::work_counters) row(counter.name, described(counter));
  }
  if (what == "metrics") {
    const auto all = [&row](const auto& table) {
      for_each_field(table, [&row](const auto& each) { row(each.name, described(each)); });
    };
    all(measure_fields);
    all(result_fields);
    all(phase_fields);
  }
  if (what == "statuses") {
    for (const auto& status : point_statuses) {
      const std::string letter = status.letter;
      row(status.name, status.meaning + (letter.empty() ? "" : " (" + letter + " in figures)"));
    }
  }
  if (what == "cases") {
    for (const HardCase& c : hard_cases(hard_case_values("paper")))
      std::cout << "  " << c.name << " (" << c.row << "): " << c.what << '\n';
  }
  if (what == "answers") {
    for (const KnownAnswer& answer : known_answers())
      std::cout << "  " << answer.name << " (" << answer.scene << "): " << answer.quantity << "; "
                << answer.source << '\n';
  }
  if (heading("suites")) {
    for (const std::string& name : profiles()) {
      const Suite suite = read_suite(source_path("configs/" + name + ".json"));
      std::cout << "  " << name << ": " << suite.description << '\n';
    }
  }
}

// The same for programs.
json solvers_json() {
  json list = json::array();
  for (const auto& backend : inextensible::backends()) {
    json settings = json::array();
    for (const auto& setting : backend.settings) {
      json row = {{"name", setting.name}, {"meaning", setting.meaning}};
      std::visit([&row](const auto& value) { row["default"] = value; }, setting.initial);
      if (!setting.choices.empty()) row["choices"] = setting.choices;
      if (setting.tunable) row["tunable"] = {setting.tunable->least, setting.tunable->largest};
      settings.push_back(std::move(row));
    }
    list.push_back({{"name", backend.name},
                    {"label", backend.label},
                    {"summary", backend.summary},
                    {"citation", backend.citation},
                    {"contestant", backend.contestant},
                    {"settings", settings}});
  }
  return list;
}

json scenes_json() {
  json list = json::array();
  for (const auto& type : scene_types()) {
    json parameters = json::array();
    for (const auto& parameter : type.parameters)
      parameters.push_back({{"name", parameter.name},
                            {"default", parameter.initial},
                            {"meaning", parameter.meaning}});
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

void list_json(const std::string& what) {
  json all = {{"solvers", solvers_json()}, {"scenes", scenes_json()}, {"suites", suites_json()}};
  if (what.empty()) {
    std::cout << document_text(all);
  } else if (all.contains(what)) {
    std::cout << document_text(all.at(what));
  } else {
    throw UsageError("--json goes with list solvers, scenes and suites");
  }
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

}  // namespace

void add_list_command(const Command& program) {
  struct Given {
    SweepOptions options;
    std::string what;
    bool as_json = false;
  };
  const auto given = std::make_shared<Given>();
  const Command command = program.subcommand(
      "list",
      "show what there is: solvers, scenes, suites, cases, answers, counters, metrics, statuses or "
      "points "
      "(points: with --sweep)");
  command.option(
      "what", given->what,
      "solvers, scenes, suites, cases, answers, counters, metrics, statuses or points; the first "
      "three "
      "if left out; result.schema and its like print that file of configs/ with what "
      "follows from tables made anew",
      "WHAT");
  add_selection(command, given->options);
  command.flag("--json", given->as_json, "solvers, scenes and suites as JSON");
  command.does([given] {
    const std::vector<std::string> schemas = generated_schemas();
    const std::vector<std::string> known{"solvers", "scenes",   "suites",  "cases",   "answers",
                                         "points",  "counters", "metrics", "statuses"};
    if (given->as_json) {
      list_json(given->what);
    } else if (given->what == "points") {
      list_points(given->options);
    } else if (const auto dot = given->what.find(".schema");
               dot != std::string::npos && std::find(schemas.begin(), schemas.end(),
                                                     given->what.substr(0, dot)) != schemas.end()) {
      std::cout << schema_text(given->what.substr(0, dot));
    } else if (given->what.empty() ||
               std::find(known.begin(), known.end(), given->what) != known.end()) {
      list(given->what);
    } else {
      throw unknown_name("list", given->what, known);
    }
    return success;
  });
}

}  // namespace harness
