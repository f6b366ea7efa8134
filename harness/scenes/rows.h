// The scenes, in the order in which they are listed. To add one: a function NAME_scene() that
// returns its SceneType, and a line here.
#pragma once

#include "harness/scenes/scene.h"

namespace harness {

#define HARNESS_SCENES(ROW) \
  ROW(chain)                \
  ROW(drape)                \
  ROW(folded_drape)         \
  ROW(fabric_drape)         \
  ROW(cotton_drape)         \
  ROW(wool_drape)           \
  ROW(polyester_drape)      \
  ROW(cusick)               \
  ROW(garment)              \
  ROW(cape)                 \
  ROW(patch)                \
  ROW(hung_patch)           \
  ROW(spinning_net)         \
  ROW(taut_row)             \
  ROW(baton)                \
  ROW(hoop)                 \
  ROW(hanging_chain)        \
  ROW(whirling_chain)       \
  ROW(catenary)             \
  ROW(folded_chain)         \
  ROW(whip)

#define HARNESS_DECLARE(name) SceneType name##_scene();
HARNESS_SCENES(HARNESS_DECLARE)
#undef HARNESS_DECLARE

}  // namespace harness
