#include "harness/points/contestant.h"

namespace harness {
namespace {

// Building takes a while where there is a body, and suites ask for one scene again and again.
const Problem& small_problem(const SceneType& type, const SceneParameters& given) {
  constexpr double enough = 11;  // the same parts as at any size
  static std::map<std::pair<std::string, SceneParameters>, std::shared_ptr<const Problem>> built;
  SceneParameters small = complete_parameters(type, given);
  small[type.resolution] = std::min(enough, small.at(type.resolution));
  auto& problem = built[{type.name, small}];
  if (!problem) problem = type.build(small).problem;
  return *problem;
}

Contestant read_contestant(const json& given, const std::string& where) {
  const json entry = given.is_string() ? json::object({{"name", given}}) : given;
  Contestant contestant;
  contestant.name = entry.value("name", "");
  contestant.solver = entry.value("solver", contestant.name);
  const auto& backend = checked_backend(contestant.solver, where);
  if (contestant.name == contestant.solver) contestant.name = backend.name;
  contestant.solver = backend.name;
  if (contestant.name.empty()) contestant.name = contestant.solver;
  contestant.settings = entry.value("settings", contestant.settings);
  check_settings(contestant.settings, where + ": 'settings'", backend);
  contestant.settings_at = entry.value("settings_at", contestant.settings_at);
  for (const SettingsAt& at : contestant.settings_at)
    check_settings(at.settings, where + ": 'settings_at'", backend);
  contestant.label = entry.value("label", "");
  contestant.unranked = entry.value("unranked", false);
  check_plain_name(contestant.name, where + ": 'name'");
  if (!contestant.own_name() && find_backend(contestant.name))
    throw UsageError(where + ": 'name' is \"" + contestant.name +
                     "\", which is the name of another solver");
  return contestant;
}

}  // namespace

Contestants::iterator find_contestant(Contestants& all, const std::string& name) {
  return std::ranges::find(all, name, &Contestant::name);
}

std::string label_of(const Contestant& contestant) {
  if (!contestant.label.empty()) return contestant.label;
  const auto* backend = find_backend(contestant.solver);
  if (contestant.own_name() && backend) return backend->label;
  std::string words = contestant.name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

const Backend& checked_backend(const std::string& name, const std::string& where) {
  const auto* backend = find_backend(name);
  if (backend) return *backend;
  throw UsageError(where + ": " + no_solver(name, names_of(backends())).what());
}

std::shared_ptr<const SceneType> checked_scene(const std::string& name, const std::string& where) {
  auto type = find_scene(name);
  if (!type) check_known("scene", name, names_of(scene_types()), where);
  return type;
}

UsageError no_solver(const std::string& name, const std::vector<std::string>& known) {
  const std::string reason = inextensible::why_no_pair(name);
  if (reason.empty()) return unknown_name("solver", name, known);
  return UsageError("there is no solver '" + name + "': " + reason);
}

bool matches(const Pattern& pattern, const std::string& solver) {
  if (pattern.matches(solver)) return true;
  const auto* backend = find_backend(solver);
  return backend && pattern.matches(std::string(backend->method) + "@" + backend->stepper);
}

void check_settings(const Settings& settings, const std::string& where, const Backend& backend) {
  const std::string kind = "setting of solver " + std::string(backend.name);
  for (const auto& setting : settings)
    check_known(kind, setting.first, names_of(backend.settings), where);
  try {
    complete_settings(backend, settings);
  } catch (const std::invalid_argument& error) {
    throw UsageError(where + ": " + error.what());
  }
}

void check_plain_name(const std::string& name, const std::string& where) {
  if (!has_form(name, "[a-z0-9_]+(@[a-z0-9_]+)?"))
    throw UsageError(
        where + " is " + value_text(name) +
        ", must be made of a-z, 0-9 and _, with one @ at most (it becomes part of point ids)");
}

Settings Contestant::settings_for(int resolution, double limit) const {
  Settings all = settings;
  const auto distance = [&](const SettingsAt& at) {
    return std::hypot(std::log(at.resolution / static_cast<double>(resolution)),
                      std::log(at.limit / limit));
  };
  const auto nearest = std::ranges::min_element(settings_at, {}, distance);
  if (nearest != settings_at.end()) all.insert(nearest->settings.begin(), nearest->settings.end());
  return all;
}

std::string not_taken(const Backend& solver, const SceneType& type, const SceneParameters& given) {
  const char* part = part_not_taken(solver, small_problem(type, given));
  return part ? part : "";
}

Contestants competitors(const SceneType& type, const SceneParameters& given) {
  Contestants all;
  for (const auto& backend : backends()) {
    const bool another = type.kind() == "chain" && *backend.same_on_chains;
    if (backend.contestant && !another && not_taken(backend, type, given).empty())
      all.push_back({backend.name, backend.name});
  }
  return all;
}

Contestants read_contestants(const json& solvers, const std::string& where) {
  Contestants all;
  for (const json& entry : solvers) {
    Contestant contestant = read_contestant(entry, where);
    if (find_contestant(all, contestant.name) != all.end())
      throw UsageError(where + ": '" + contestant.name +
                       "' is listed twice; give each a \"name\" of its own");
    all.push_back(std::move(contestant));
  }
  return all;
}

void to_json(json& to, const Contestant& c) {
  if (c == Contestant{c.solver, c.solver}) {
    to = c.solver;
    return;
  }
  to = {{"name", c.name}, {"solver", c.solver}, {"settings", c.settings}};
  if (!c.label.empty()) to["label"] = c.label;
  if (c.unranked) to["unranked"] = true;
  if (!c.settings_at.empty()) to["settings_at"] = c.settings_at;
}

std::string double_of(const std::string& name) { return name + "_again"; }

void add_double(Contestants& all, const std::string& name) {
  const auto place = find_contestant(all, name);
  if (place == all.end() || find_contestant(all, double_of(name)) != all.end()) return;
  Contestant again = *place;
  again.name = double_of(name);
  again.label = label_of(*place) + " again";
  again.unranked = true;
  all.insert(place + 1, std::move(again));
}

}  // namespace harness
