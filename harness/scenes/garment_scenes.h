// A garment that a body holds by nothing but its shape.
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

SceneType garment_scene();

}  // namespace harness
