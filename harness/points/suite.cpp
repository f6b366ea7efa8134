#include "harness/points/suite.h"

#include <algorithm>
#include <optional>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/json.h"
#include "harness/base/pattern.h"
#include "harness/base/text.h"
#include "harness/points/point_json.h"
#include "harness/points/tuned.h"

namespace harness {
namespace {

using nlohmann::json;

void read_limits(JsonReader& reader, const std::string& where, SweepSpec& spec) {
  spec.limits = reader.numbers("limits", Bounds::strain());
  if (const double limit = reader.number("limit", 0, Bounds::strain()); limit > 0) {
    if (!spec.limits.empty()) throw UsageError(where + ": give 'limit' or 'limits', not both");
    spec.limits = {limit};
  }
  if (spec.limits.empty())
    throw UsageError(where + ": 'limits' is missing, for example \"limits\": [0.1, 0.01]");
}

void read_scene_parameters(JsonReader& reader, const SceneType& type, SweepSpec& spec) {
  for (const double n : reader.numbers("resolutions", Bounds::whole_number(2)))
    spec.resolutions.push_back(static_cast<int>(n));
  if (const json* given = reader.find("scene_parameters")) {
    JsonReader parameters(*given, reader.where("scene_parameters"));
    for (const auto& entry : given->items())
      spec.scene_parameters[entry.key()] = parameters.number(entry.key(), 0, {});
  }
  if (!spec.resolutions.empty()) return;
  const SceneParameters complete = complete_parameters(type, spec.scene_parameters);
  spec.resolutions = {static_cast<int>(complete.at(type.resolution))};
}

void read_steps(JsonReader& reader, const std::string& where, SweepSpec& spec) {
  if (const json* steps = reader.find("steps")) {
    JsonReader ladder(*steps, where + ": 'steps'");
    const Bounds within_a_frame{.least = 0, .above = true, .most = longest_step * (1 + 1e-9)};
    spec.coarsest = ladder.number("coarsest", spec.coarsest, within_a_frame);
    spec.finest = ladder.number("finest", spec.finest, Bounds::positive());
    spec.adaptive = ladder.flag("adaptive", spec.adaptive);
    spec.every_step = ladder.flag("all", spec.every_step);
    ladder.finish();
    if (spec.finest > spec.coarsest)
      throw UsageError(where + ": 'steps': 'finest' is larger than 'coarsest'");
  }
  if (spec.adaptive && spec.sweep == "step")
    throw UsageError(where + ": a step sweep has fixed steps, so no 'adaptive' ones");
  if (spec.adaptive && spec.every_step)
    throw UsageError(where + ": 'steps': 'adaptive' and 'all' exclude each other");
}

void read_solver_options(JsonReader& reader, const std::string& where, SweepSpec& spec) {
  const json* options = reader.find("solver_options");
  if (!options) return;
  if (!options->is_object()) reader.fail_at("solver_options", *options, "an object { ... }");
  for (const auto& [name, value] : options->items()) {
    const auto& backend = checked_backend(name, where + ": 'solver_options'");
    spec.solver_options[name] = read_settings(value, where + ": 'solver_options'", backend);
  }
}

// Impossible values are found before anything runs.
void fit_steps_to_duration(const SceneType& type, bool coarsest_given, SweepSpec& spec) {
  const double duration = complete_parameters(type, spec.scene_parameters).at("duration");
  if (!coarsest_given) spec.coarsest = std::min(spec.coarsest, duration);
  if (spec.coarsest > duration)
    throw UsageError("'duration' is " + number_text(duration) +
                     " s, must be at least the longest step, " + number_text(spec.coarsest) +
                     " s ('steps': 'coarsest')");
  if (duration / spec.finest > most_steps)
    throw UsageError("'duration' is " + number_text(duration) + " s, more than " +
                     number_text(most_steps) + " steps of " + number_text(spec.finest) +
                     " s ('steps': 'finest')");
}

SweepSpec read_sweep(const json& object, const std::string& where, const Tuned* tuned,
                     const std::string& same) {
  JsonReader reader(object, where);
  SweepSpec spec;
  spec.sweep = reader.text("sweep", "");
  check_known("sweep", spec.sweep, sweep_kinds(), where);
  spec.scene = reader.text("scene", "");
  const auto type = checked_scene(spec.scene, where);
  const json* solvers = reader.find("solvers");
  read_limits(reader, where, spec);
  read_scene_parameters(reader, *type, spec);
  read_steps(reader, where, spec);
  read_solver_options(reader, where, spec);
  const json* steps = reader.find("steps");
  reader.finish();
  try {
    fit_steps_to_duration(*type, steps && steps->contains("coarsest"), spec);
    if (!solvers) spec.contestants = competitors(*type, spec.scene_parameters);
  } catch (const UsageError& error) {
    throw UsageError(where + ": 'scene_parameters': " + error.what());
  }
  if (solvers) spec.contestants = read_contestants(*solvers, where + ": 'solvers'");
  if (tuned) tune(spec.contestants, *tuned, type->kind(), spec.solver_options);
  add_double(spec.contestants, same);
  return spec;
}

// One name is one solver, in all sweeps, for it has one place in the legend.
void check_contestants(const Suite& suite, const JsonReader& reader) {
  std::map<std::string, std::string> solvers;
  for (const SweepSpec& sweep : suite.sweeps) {
    for (const Contestant& c : sweep.contestants) {
      if (const auto [place, fresh] = solvers.emplace(c.name, c.solver); place->second != c.solver)
        throw UsageError(reader.where("sweeps") + ": '" + c.name + "' is solver '" + place->second +
                         "' in one sweep and '" + c.solver + "' in another");
    }
  }
  if (!suite.same.empty())
    check_known("contestant", suite.same, names_of(contestants_of(suite)), reader.where("same"));
}

}  // namespace

std::vector<std::string> sweep_kinds() { return {"strain", "resolution", "step"}; }

std::vector<double> levels_of(const Suite& suite) {
  std::vector<double> levels(answer_levels.begin(), answer_levels.end());
  std::erase_if(levels, [&suite](double level) { return level < suite.finest_error; });
  return levels;
}

Contestants contestants_of(const Suite& suite) {
  Contestants all;
  for (const SweepSpec& sweep : suite.sweeps) {
    for (const Contestant& c : sweep.contestants) {
      if (find_contestant(all, c.name) == all.end()) all.push_back(c);
    }
  }
  return all;
}

Suite read_suite(const std::string& path) { return parse_suite(read_file(path, "suite"), path); }

Suite parse_suite(const std::string& text, const std::string& path) {
  const json document = parse_document(text, path);
  JsonReader reader(document, "suite '" + path + "'");
  Suite suite;
  suite.name = reader.text("name", "unnamed");
  if (!has_form(suite.name, "[A-Za-z0-9_][A-Za-z0-9_.-]{0,99}"))
    throw UsageError(reader.where("name") + " is " + value_text(suite.name) +
                     ", must be letters, digits, _ . and - (results are named after it)");
  suite.description = reader.text("description", "");
  suite.profile = reader.text("profile", "custom");
  suite.seed = static_cast<std::uint64_t>(reader.number("seed", 1, Bounds::exact_number()));
  suite.reps = static_cast<int>(reader.number("reps", 3, Bounds::whole_number(1)));
  suite.timeout = reader.number("timeout", 60, Bounds::positive());
  suite.finest_error = reader.number("finest_error", suite.finest_error, Bounds::positive());
  std::optional<Tuned> tuned;
  if (const std::string file = reader.text("tuned", ""); !file.empty()) {
    tuned = read_tuned_up_to_date(file);
    suite.tuned_file = tuned->file;
    suite.tuned_hash = tuned->hash;
  }
  suite.same = reader.text("same", "");
  const json* sweeps = reader.find("sweeps");
  if (!sweeps || !sweeps->is_array() || sweeps->empty())
    throw UsageError(reader.where("sweeps") + " must be a list of sweeps");
  for (std::size_t i = 0; i < sweeps->size(); ++i) {
    suite.sweeps.push_back(read_sweep((*sweeps)[i],
                                      "suite '" + path + "': sweeps[" + std::to_string(i) + "]",
                                      tuned ? &*tuned : nullptr, suite.same));
  }
  check_contestants(suite, reader);
  reader.finish();
  return suite;
}

json to_json(const Suite& suite) {
  json sweeps = json::array();
  for (const SweepSpec& s : suite.sweeps) {
    sweeps.push_back({{"sweep", s.sweep},
                      {"scene", s.scene},
                      {"solvers", s.contestants},
                      {"limits", s.limits},
                      {"resolutions", s.resolutions},
                      {"steps",
                       {{"coarsest", s.coarsest},
                        {"finest", s.finest},
                        {"adaptive", s.adaptive},
                        {"all", s.every_step}}},
                      {"scene_parameters", s.scene_parameters},
                      {"solver_options", s.solver_options}});
  }
  json document = {{"name", suite.name},
                   {"description", suite.description},
                   {"profile", suite.profile},
                   {"seed", suite.seed},
                   {"reps", suite.reps},
                   {"timeout", suite.timeout},
                   {"finest_error", suite.finest_error},
                   {"sweeps", sweeps}};
  if (!suite.same.empty()) document["same"] = suite.same;
  return document;
}

}  // namespace harness
