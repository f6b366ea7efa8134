#include "harness/scenes/scene.h"

#include <cmath>

#include "harness/base/errors.h"
#include "harness/base/text.h"
#include "harness/scenes/cape_scenes.h"
#include "harness/scenes/cloth_scenes.h"
#include "harness/scenes/disc_scenes.h"
#include "harness/scenes/folded_scenes.h"
#include "harness/scenes/garment_scenes.h"
#include "harness/scenes/hanging_scenes.h"
#include "harness/scenes/line_scenes.h"
#include "harness/scenes/mesh_scenes.h"
#include "harness/scenes/spinning_scenes.h"

namespace harness {
namespace {

// A scene is a function that returns its SceneType, and a line here.
const std::vector<SceneType>& table() {
  static const std::vector<SceneType> rows = {
      chain_scene(),         drape_scene(),          folded_drape_scene(),    fabric_drape_scene(),
      cotton_drape_scene(),  wool_drape_scene(),     polyester_drape_scene(), cusick_scene(),
      garment_scene(),       cape_scene(),           patch_scene(),           hung_patch_scene(),
      spinning_net_scene(),  taut_row_scene(),       baton_scene(),           hoop_scene(),
      hanging_chain_scene(), whirling_chain_scene(), catenary_scene(),        folded_chain_scene(),
      whip_scene(),
  };
  return rows;
}

}  // namespace

std::span<const SceneType> scene_types() { return table(); }

std::shared_ptr<const SceneType> find_scene(std::string_view name) {
  if (names_mesh(name)) return std::make_shared<const SceneType>(mesh_scene(std::string(name)));
  for (const SceneType& type : table()) {
    if (type.name == name) return {std::shared_ptr<const SceneType>(), &type};  // lives for ever
  }
  return nullptr;
}

std::vector<std::string> scene_kinds() {
  std::vector<std::string> kinds;
  for (const SceneType& type : table()) {
    if (!*type.like) kinds.emplace_back(type.name);
  }
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
                              : info.low == -1e-300 ? "at least 0"
                                                    : "above " + number_text(info.low);
    throw UsageError("scene " + type.name + ": '" + info.name + "' is " + number_text(value) +
                     ", must be " + bound + " and at most " + number_text(info.high));
  }
  return all;
}

}  // namespace harness
