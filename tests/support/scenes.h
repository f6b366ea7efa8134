#pragma once

#include "harness/scenes/scene.h"

namespace harness::testing {

// A scene's parameters; those that are not given have the scene's own values.
inline SceneParameters parameters(const std::string& name, const SceneParameters& given = {}) {
  return complete_parameters(*find_scene(name), given);
}

}  // namespace harness::testing
