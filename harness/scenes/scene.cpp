#include "harness/scenes/scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "harness/scenes/meshes.h"
#include "harness/scenes/scene_folder.h"

namespace harness {

std::span<const SceneType> scene_types() {
  static const std::vector<SceneType> types = [] {
    std::vector<SceneType> all;
    const auto add = [&all](std::vector<SceneType> family) {
      std::ranges::move(family, std::back_inserter(all));
    };
    add(line_scenes());
    add(cloth_scenes());
    add(worn_scenes());
    add(spinning_scenes());
    add(hanging_scenes());
    return all;
  }();
  return types;
}

std::shared_ptr<const SceneType> find_scene(std::string_view name) {
  static std::map<std::string, std::shared_ptr<const SceneType>> known;  // names have a hash
  if (const bool mesh = names_mesh(name); mesh || names_folder(name)) {
    const std::string text(name);
    if (known.contains(text)) return known.at(text);
    const auto type =
        std::make_shared<const SceneType>(mesh ? mesh_scene(text) : folder_scene(text));
    return known[type->name] = type;
  }
  for (const SceneType& type : scene_types())
    if (type.name == name) return {std::shared_ptr<const SceneType>(), &type};  // static
  return nullptr;
}

std::vector<std::string> scene_kinds() {
  std::vector<std::string> kinds;
  for (const SceneType& type : scene_types())
    if (type.like.empty()) kinds.emplace_back(type.name);
  return kinds;
}

SceneParameters complete_parameters(const SceneType& type, const SceneParameters& given) {
  SceneParameters all;
  std::vector<std::string> names;
  for (const auto& info : type.parameters) {
    all[info.name] = info.initial;
    names.emplace_back(info.name);
  }
  for (const auto& [name, value] : given) {
    if (!all.contains(name)) throw unknown_name("parameter of scene " + type.name, name, names);
    all[name] = value;
  }
  for (const auto& info : type.parameters) {
    const double value = all[info.name];
    const bool inside = (info.integer ? value >= info.low : value > info.low) && value <= info.high;
    if (inside && (!info.integer || value == std::floor(value))) continue;
    const std::string bound = info.integer ? "a whole number of at least " + number_text(info.low)
                              : info.low == zero_too ? "at least 0"
                                                     : "above " + number_text(info.low);
    throw UsageError(concat("scene ", type.name, ": '", info.name, "' is ", value, ", must be ",
                            bound, " and at most ", info.high));
  }
  return all;
}

Scene built_scene(std::string_view name, const SceneParameters& given) {
  const auto type = find_scene(name);
  return type->build(complete_parameters(*type, given));
}

}  // namespace harness
