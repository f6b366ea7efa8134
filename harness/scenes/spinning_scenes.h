// What spins in its plane, free and without weight: each a rigid rotation for ever, held by its
// edges against the centrifugal force.
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

SceneType spinning_net_scene();
SceneType baton_scene();
SceneType hoop_scene();

}  // namespace harness
