// Cusick's drape test: a disc of cloth on a smaller round table.
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

SceneType cusick_scene();

}  // namespace harness
