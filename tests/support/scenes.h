#pragma once

#include "harness/scenes/scene.h"

namespace harness::testing {

// A scene by its name; parameters that are not given have the scene's own values.
inline Scene build(const char* name, const SceneParameters& given) {
  const auto found_type = find_scene(name);
  const SceneType& type = *found_type;
  return type.build(complete_parameters(type, given));
}

}  // namespace harness::testing
