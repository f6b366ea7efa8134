// Scenes of a square of cloth.
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

SceneType drape_scene();
SceneType folded_drape_scene();
SceneType patch_scene();
SceneType spinning_net_scene();

}  // namespace harness
