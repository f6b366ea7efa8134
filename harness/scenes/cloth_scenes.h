// Scenes of a square of cloth.
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

SceneType drape_scene();
SceneType folded_drape_scene();
SceneType fabric_drape_scene();
SceneType cotton_drape_scene();
SceneType wool_drape_scene();
SceneType polyester_drape_scene();
SceneType patch_scene();
SceneType hung_patch_scene();

}  // namespace harness
