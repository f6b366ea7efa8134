#include "harness/points/suite.h"

#include "harness/base/files.h"
#include "harness/base/text.h"
#include "harness/points/schema.h"
#include "harness/points/tuned.h"

namespace harness {
namespace {

SweepSpec read_sweep(const json& object, const std::string& where, const Tuned* tuned,
                     const std::string& same) {
  SweepSpec spec = object;
  const auto type = checked_scene(spec.scene, where);
  spec.scene = type->name;  // of a mesh: with its content
  if (object.contains("limit") == object.contains("limits"))
    throw UsageError(where + ": give 'limit' or 'limits', for example \"limits\": [0.1, 0.01]");
  if (object.contains("limit")) spec.limits = {object.at("limit").get<double>()};
  const json steps = object.value("steps", json::object());
  spec.coarsest = steps.value("coarsest", spec.coarsest);
  spec.finest = steps.value("finest", spec.finest);
  spec.every_step = steps.value("all", spec.every_step);
  spec.refine = steps.value("refine", spec.refine);
  if (spec.finest > spec.coarsest)
    throw UsageError(where + ": 'steps': 'finest' is larger than 'coarsest'");
  for (const auto& [name, settings] : spec.solver_options) {
    const std::string place = where + ": 'solver_options'";
    check_settings(settings, place, checked_backend(name, place));
  }
  const bool solvers = object.contains("solvers");
  try {
    const SceneParameters complete = complete_parameters(*type, spec.scene_parameters);
    if (spec.resolutions.empty())
      spec.resolutions = {static_cast<int>(complete.at(type->resolution))};
    const double duration = complete.at("duration");
    if (!steps.contains("coarsest")) spec.coarsest = std::min(spec.coarsest, duration);
    if (spec.coarsest > duration)
      throw UsageError(concat("'duration' is ", duration, " s, must be at least the longest step, ",
                              spec.coarsest, " s ('steps': 'coarsest')"));
    if (duration / spec.finest > most_steps)
      throw UsageError(concat("'duration' is ", duration, " s, more than ", most_steps,
                              " steps of ", spec.finest, " s ('steps': 'finest')"));
    if (!solvers) spec.contestants = competitors(*type, spec.scene_parameters);
    if (const std::string without = object.value("without", ""); !without.empty())
      std::erase_if(spec.contestants, [drop = Pattern(where + ": 'without'", without)](
                                          const Contestant& c) { return drop.matches(c.name); });
  } catch (const UsageError& error) {
    throw UsageError(where + ": 'scene_parameters': " + error.what());
  }
  if (solvers) spec.contestants = read_contestants(object.at("solvers"), where + ": 'solvers'");
  if (tuned) tune(spec.contestants, *tuned, type->kind(), spec.solver_options);
  add_double(spec.contestants, same);
  return spec;
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
  for (const SweepSpec& sweep : suite.sweeps)
    for (const Contestant& c : sweep.contestants)
      if (find_contestant(all, c.name) == all.end()) all.push_back(c);
  return all;
}

json suite_document(const std::string& text, const std::string& path) {
  json document = parse_document(text, path);
  check_schema(document, "suite", path);
  return document;
}

Suite suite_of(const json& document, const std::string& path) {
  const std::string where = "suite '" + path + "'";
  Suite suite = document;
  if (!has_form(suite.name, "[A-Za-z0-9_][A-Za-z0-9_.-]{0,99}"))
    throw UsageError(where + ": 'name' is " + value_text(suite.name) +
                     ", must be letters, digits, _ . and - (results are named after it)");
  suite.same = document.value("same", "");
  suite.far_behind = document.value("far_behind", suite.far_behind);
  std::optional<Tuned> tuned;
  if (const std::string file = document.value("tuned", ""); !file.empty()) {
    tuned = read_tuned_up_to_date(file);
    suite.tuned_file = tuned->file;
    suite.tuned_hash = tuned->hash;
  }
  for (const json& sweep : document.at("sweeps"))
    suite.sweeps.push_back(
        read_sweep(sweep, where + ": sweeps[" + std::to_string(suite.sweeps.size()) + "]",
                   tuned ? &*tuned : nullptr, suite.same));
  // One name is one solver, in all sweeps, for it has one place in the legend.
  std::map<std::string, std::string> solvers;
  for (const SweepSpec& sweep : suite.sweeps)
    for (const Contestant& c : sweep.contestants)
      if (const auto [place, fresh] = solvers.emplace(c.name, c.solver); place->second != c.solver)
        throw UsageError(where + ": '" + c.name + "' is solver '" + place->second +
                         "' in one sweep and '" + c.solver + "' in another");
  if (!suite.same.empty())
    check_known("contestant", suite.same, names_of(contestants_of(suite)), where + ": 'same'");
  return suite;
}

Suite parse_suite(const std::string& text, const std::string& path) {
  return suite_of(suite_document(text, path), path);
}

Suite read_suite(const std::string& path) { return parse_suite(read_file(path, "suite"), path); }

json to_json(const Suite& suite) {
  json document = suite;
  document["sweeps"] = json::array();
  for (const SweepSpec& s : suite.sweeps) {
    json& sweep = document["sweeps"].emplace_back(s);
    sweep["solvers"] = s.contestants;
    sweep["steps"] = {{"coarsest", s.coarsest},
                      {"finest", s.finest},
                      {"all", s.every_step},
                      {"refine", s.refine}};
  }
  if (!suite.same.empty()) document["same"] = suite.same;
  if (std::isfinite(suite.far_behind)) document["far_behind"] = suite.far_behind;
  return document;
}

}  // namespace harness
