#include "harness/points/tuned.h"

#include <algorithm>
#include <filesystem>
#include <variant>

#include "harness/base/errors.h"
#include "harness/base/fields.h"
#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/base/paths.h"
#include "harness/base/text.h"
#include "harness/points/context.h"
#include "harness/points/point_json.h"
#include "harness/scenes/scene.h"

namespace harness {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* schema = "inextensible-tuned/3";

const json& list_in(JsonReader& reader, const char* key) {
  const json* list = reader.find(key);
  if (!list || !list->is_array()) throw UsageError(reader.where(key) + " must be a list");
  return *list;
}

TunedPlace read_place(const json& object, const std::string& where,
                      const inextensible::Backend& backend) {
  JsonReader reader(object, where);
  TunedPlace place;
  place.resolution =
      static_cast<int>(reader.number("resolution", 0, {.least = 1, .most = 1e6, .whole = true}));
  for (const auto& [key, member] :
       {std::pair("limit", &TunedPlace::limit),
        std::pair("default_seconds", &TunedPlace::default_seconds),
        std::pair("default_step", &TunedPlace::default_step),
        std::pair("seconds", &TunedPlace::seconds), std::pair("step", &TunedPlace::step)})
    place.*member = reader.number(key, 0, Bounds::positive());
  place.evaluations =
      static_cast<int>(reader.number("evaluations", 0, {.least = 0, .most = 1e9, .whole = true}));
  if (const json* settings = reader.find("settings")) {
    place.settings = read_settings(*settings, where + ": 'settings'", backend);
    check_settings(place.settings, where + ": 'settings'", backend);
  }
  reader.finish();
  return place;
}

TunedEntry read_entry(const json& object, const std::string& where) {
  JsonReader reader(object, where);
  TunedEntry entry;
  entry.kind = reader.one_of("kind", "", scene_kinds(), "kind of scene");
  entry.solver = reader.text("solver", "");
  const auto& backend = checked_backend(entry.solver, where);
  entry.budget =
      static_cast<int>(reader.number("budget", 0, {.least = 0, .most = 1e9, .whole = true}));
  for (const json& place : list_in(reader, "places"))
    entry.places.push_back(read_place(place, where + ": 'places'", backend));
  const json* rule = reader.find("rule");
  if (!rule || !rule->is_object()) throw UsageError(reader.where("rule") + " must be an object");
  entry.rule = *rule;
  if (const json* context = reader.find("context")) entry.context = *context;
  reader.finish();
  return entry;
}

// Two files with the same settings are the same to a sweep, whenever they were found.
std::string hash_of(const std::vector<TunedEntry>& entries) {
  std::map<std::string, json> settings;
  for (const TunedEntry& entry : entries)
    settings[entry.kind + "/" + entry.solver] = to_json(entry.settings_at());
  return fnv1a(json(settings).dump());
}

}  // namespace

std::vector<SettingsAt> TunedEntry::settings_at() const {
  std::vector<SettingsAt> all;
  for (const TunedPlace& p : places) all.push_back({p.resolution, p.limit, p.settings});
  return all;
}

const TunedEntry* Tuned::find(const std::string& kind, const std::string& solver) const {
  const auto place = std::find_if(entries.begin(), entries.end(), [&](const TunedEntry& e) {
    return e.kind == kind && e.solver == solver;
  });
  return place == entries.end() ? nullptr : &*place;
}

Tuned read_tuned(const std::string& file) {
  const bool path = file.find('/') != std::string::npos;
  return parse_tuned(
      read_file(path ? file : source_path("configs/" + file), "file of tuned settings"), file);
}

Tuned parse_tuned(const std::string& text, const std::string& file) {
  const json document = parse_commented(text, file);
  const std::string where = "tuned settings '" + file + "'";
  JsonReader reader(document, where);
  if (reader.text("schema", "") != schema)
    throw UsageError(where + ": 'schema' must be \"" + schema + "\"");
  Tuned tuned;
  tuned.file = std::filesystem::path(file).filename().string();  // results name no folders
  const json& list = list_in(reader, "tuned");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string place = where + ": tuned[" + std::to_string(i) + "]";
    TunedEntry entry = read_entry(list[i], place);
    if (tuned.find(entry.kind, entry.solver))
      throw UsageError(place + ": " + entry.kind + " and " + entry.solver + " stand there twice");
    tuned.entries.push_back(std::move(entry));
  }
  reader.finish();
  tuned.hash = hash_of(tuned.entries);
  return tuned;
}

ordered_json tuned_document(const std::vector<TunedEntry>& entries) {
  ordered_json list = ordered_json::array();
  for (const TunedEntry& entry : entries) {
    ordered_json places = ordered_json::array();
    for (const TunedPlace& p : entry.places)
      places.push_back({{"resolution", p.resolution},
                        {"limit", p.limit},
                        {"settings", to_json(p.settings)},
                        {"evaluations", p.evaluations},
                        {"default_seconds", p.default_seconds},
                        {"default_step", p.default_step},
                        {"seconds", p.seconds},
                        {"step", p.step}});
    list.push_back({{"kind", entry.kind},
                    {"solver", entry.solver},
                    {"budget", entry.budget},
                    {"places", places},
                    {"rule", entry.rule},
                    {"context", entry.context}});
  }
  return {{"schema", schema}, {"tuned", list}};
}

void tune(Contestants& all, const Tuned& tuned, const std::string& kind,
          const std::map<std::string, inextensible::Settings>& given, bool untuned) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const TunedEntry* entry = all[i].own_name() ? tuned.find(kind, all[i].solver) : nullptr;
    if (!entry) continue;
    Contestant before = all[i];
    const auto fixed = given.find(before.solver);
    all[i].settings_at = entry->settings_at();
    bool differs = false;
    for (SettingsAt& at : all[i].settings_at) {
      std::erase_if(at.settings, [&](const auto& setting) {
        return before.settings.contains(setting.first) ||
               (fixed != given.end() && fixed->second.contains(setting.first));
      });
      differs = differs || !at.settings.empty();
    }
    if (!differs) all[i].settings_at.clear();
    before.name += "_untuned";
    if (!untuned || !differs || find_contestant(all, before.name) != all.end()) continue;
    before.label = label_of(all[i]) + ", untuned";
    before.unranked = true;
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(i) + 1, std::move(before));
    ++i;
  }
}

namespace {

using nlohmann::json;

SweepSpec tuning_scene(const char* scene, std::vector<int> sizes, double coarsest,
                       double duration) {
  SweepSpec spec;
  spec.sweep = "strain";
  spec.scene = scene;
  spec.limits = {0.02, 0.002, 0.0002};
  spec.resolutions = std::move(sizes);
  spec.coarsest = coarsest;
  spec.finest = 1.0 / 6400;
  spec.scene_parameters = {{"duration", duration}};
  return spec;
}

// Null where it was found by today's rule; else the first difference, as a step of a JSON patch.
json first_difference(const TunedEntry& entry) {
  const auto& scenes = tuning_scenes();
  const auto scene = std::find_if(scenes.begin(), scenes.end(), [&entry](const SweepSpec& s) {
    return find_scene(s.scene)->kind() == entry.kind;
  });
  if (scene == scenes.end()) return {{"path", "/scene"}};
  const json difference =
      json::diff(entry.rule, tuning_rule(*scene, *inextensible::find_backend(entry.solver)));
  return difference.empty() ? json() : difference.front();
}

}  // namespace

const std::vector<SweepSpec>& tuning_scenes() {
  // The drape is hardest from 0.3 s on, where it has sheared.
  static const std::vector<SweepSpec> scenes{tuning_scene("chain", {50, 200}, 0.04, 1),
                                             tuning_scene("drape", {25, 55}, 0.02, 0.6),
                                             tuning_scene("patch", {13, 19}, 0.02, 0.4),
                                             tuning_scene("spinning_net", {13, 25}, 0.04, 0.5)};
  return scenes;
}

std::vector<int> smaller_sizes(const std::string& scene) {
  if (scene == "chain") return {25, 12};
  if (scene == "drape") return {15, 11};
  if (scene == "spinning_net") return {9, 7};
  return {};  // of the patch there are no smaller references
}

json tuning_rule(const SweepSpec& scene, const inextensible::Backend& solver) {
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

bool up_to_date(const TunedEntry& entry) { return first_difference(entry).is_null(); }

Tuned read_tuned_up_to_date(const std::string& file) {
  Tuned tuned = read_tuned(file);
  for (const TunedEntry& entry : tuned.entries) {
    const json difference = first_difference(entry);
    if (difference.is_null()) continue;
    const std::string path = difference.at("path");
    const json::json_pointer place(path);
    const std::string was = entry.rule.contains(place) ? entry.rule.at(place).dump() : "missing";
    const std::string is = difference.contains("value") ? difference.at("value").dump() : "missing";
    throw UsageError("tuned settings '" + tuned.file + "': those of " + entry.solver + " for the " +
                     entry.kind + " were found with " + path.substr(1) + " = " + was +
                     ", which is " + is + " now; search again: bench tune --scene " + entry.kind +
                     " --solver " + entry.solver);
  }
  return tuned;
}

}  // namespace harness
