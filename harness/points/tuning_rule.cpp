#include "harness/points/tuning_rule.h"

#include <algorithm>
#include <variant>

#include "harness/base/errors.h"
#include "harness/scenes/scene.h"

namespace harness {
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
                     ", which is " + is + " now; find them anew: bench tune --scene " + entry.kind +
                     " --solver " + entry.solver);
  }
  return tuned;
}

}  // namespace harness
