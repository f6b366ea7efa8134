// A cape that a body wears while it walks and turns.
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

SceneType cape_scene();

}  // namespace harness
