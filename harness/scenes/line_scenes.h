// Scenes of vertices on a line.
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

SceneType chain_scene();
SceneType taut_row_scene();

}  // namespace harness
