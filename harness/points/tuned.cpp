#include "harness/points/tuned.h"

#include "harness/base/files.h"
#include "harness/base/text.h"
#include "harness/points/context.h"
#include "harness/points/plugins.h"
#include "harness/points/schema.h"

namespace harness {
namespace {

SweepSpec tuning_scene(const char* scene, std::vector<int> sizes, double coarsest, double duration,
                       std::vector<double> limits = {0.02, 0.002, 0.0002}) {
  return {.sweep = "strain",
          .scene = scene,
          .limits = std::move(limits),
          .resolutions = std::move(sizes),
          .coarsest = coarsest,
          .finest = 1.0 / 6400,
          .scene_parameters = {{"duration", duration}}};
}

}  // namespace

std::vector<SettingsAt> TunedEntry::settings_at() const { return {places.begin(), places.end()}; }

const TunedEntry* Tuned::find(const std::string& kind, const std::string& solver) const {
  const auto place = std::ranges::find_if(
      entries, [&](const TunedEntry& e) { return e.kind == kind && e.solver == solver; });
  return place == entries.end() ? nullptr : &*place;
}

Tuned parse_tuned(const std::string& text, const std::string& file) {
  const json document = parse_document(text, file);
  check_schema(document, "tuned", file);
  Tuned tuned;
  tuned.file = std::filesystem::path(file).filename().string();  // results name no folders
  for (const json& object : document.at("tuned")) {
    const std::string place =
        "tuned settings '" + file + "': tuned[" + std::to_string(tuned.entries.size()) + "]";
    TunedEntry entry = object;
    check_known("kind of scene", entry.kind, scene_kinds(), place);
    const auto& backend = checked_backend(entry.solver, place);
    for (const TunedPlace& at : entry.places)
      check_settings(at.settings, place + ": 'settings'", backend);
    if (tuned.find(entry.kind, entry.solver))
      throw UsageError(place + ": " + entry.kind + " and " + entry.solver + " are listed twice");
    tuned.entries.push_back(std::move(entry));
  }
  // Two files with the same settings are the same to a sweep, whenever they were found.
  json settings = json::object();
  for (const TunedEntry& entry : tuned.entries)
    settings[entry.kind + "/" + entry.solver] = entry.settings_at();
  tuned.hash = fnv1a(settings.dump());
  return tuned;
}

json tuned_document(const std::vector<TunedEntry>& entries) {
  return {{"schema", "inextensible-tuned/3"}, {"tuned", entries}};
}

void tune(Contestants& all, const Tuned& tuned, const std::string& kind,
          const std::map<std::string, Settings>& given) {
  for (Contestant& contestant : all) {
    const TunedEntry* entry = contestant.own_name() ? tuned.find(kind, contestant.solver) : nullptr;
    if (!entry) continue;
    const auto fixed = given.find(contestant.solver);
    contestant.settings_at = entry->settings_at();
    for (SettingsAt& at : contestant.settings_at)
      std::erase_if(at.settings, [&](const auto& setting) {
        return contestant.settings.contains(setting.first) ||
               (fixed != given.end() && fixed->second.contains(setting.first));
      });
    if (std::ranges::all_of(contestant.settings_at,
                            [](const SettingsAt& at) { return at.settings.empty(); }))
      contestant.settings_at.clear();
  }
}

const std::vector<SweepSpec>& tuning_scenes() {
  // The drape is hardest from 0.3 s on, where it has sheared.
  static const std::vector<SweepSpec> scenes{tuning_scene("chain", {50, 200}, 0.04, 1),
                                             tuning_scene("drape", {25, 55}, 0.02, 0.6),
                                             tuning_scene("settling_drape", {21}, 0.02, 3, {0.001}),
                                             tuning_scene("patch", {13, 19}, 0.02, 0.4),
                                             tuning_scene("spinning_net", {13, 25}, 0.04, 0.5)};
  return scenes;
}

std::vector<int> smaller_sizes(const std::string& scene) {
  if (scene == "chain") return {25, 12};
  if (scene == "drape") return {15, 11};
  if (scene == "spinning_net") return {9, 7};
  return {};  // of the others there are no smaller references
}

json tuning_rule(const SweepSpec& scene, const Backend& solver) {
  const auto type = find_scene(scene.scene);
  SceneParameters parameters = complete_parameters(*type, scene.scene_parameters);
  parameters.erase(type->resolution);
  json settings = json::object();
  for (const auto& info : solver.settings) {
    json& setting = settings[info.name];
    std::visit([&setting](const auto& initial) { setting["default"] = initial; }, info.initial);
    if (!info.tunable) continue;
    setting["range"] = {info.tunable->least, info.tunable->largest};
    if (info.tunable->bound) setting["bound"] = *info.tunable->bound;
  }
  return {{"scene", scene.scene},       {"scene_parameters", parameters},
          {"sizes", scene.resolutions}, {"smaller_sizes", smaller_sizes(scene.scene)},
          {"limits", scene.limits},     {"steps", {scene.coarsest, scene.finest}},
          {"error", headline_error},    {"search", "dynamically dimensioned search"},
          {"settings", settings}};
}

std::string rule_change(const TunedEntry& entry) {
  const auto scene = std::ranges::find(
      tuning_scenes(), entry.kind, [](const SweepSpec& s) { return find_scene(s.scene)->kind(); });
  if (scene == tuning_scenes().end()) return "the scene, " + entry.kind + ", no longer exists";
  return difference(entry.rule, tuning_rule(*scene, *find_backend(entry.solver)));
}

std::string tune_command(const std::string& kind, const std::string& solver,
                         const std::string& file) {
  const bool plugged = std::ranges::any_of(loaded_plugins(), [&](const Plugin& plugin) {
    return std::ranges::find(plugin.solvers, solver) != plugin.solvers.end();
  });
  return "bench tune --scene " + kind + " --solver " + solver + (plugged ? " --plugin FILE" : "") +
         (file.empty() ? "" : " -o " + file);
}

Tuned read_tuned_up_to_date(const std::string& file) {
  const bool path = file.find('/') != std::string::npos;
  Tuned tuned = parse_tuned(
      read_file(path ? file : source_path("configs/" + file), "file of tuned settings"), file);
  for (const TunedEntry& entry : tuned.entries)
    if (const std::string change = rule_change(entry); !change.empty())
      throw UsageError(
          "tuned settings '" + tuned.file + "': those of " + entry.solver + " for the " +
          entry.kind + " were found by another rule: " + change +
          "; search again: " + tune_command(entry.kind, entry.solver, path ? file : ""));
  return tuned;
}

}  // namespace harness
