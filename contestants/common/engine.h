// What the rows of all engines share.
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/problem/stopwatch.h"

namespace engines {

// A row with what engines do not take; `label` and `summary` name the engine and its version.
inline inextensible::Backend engine_row(const char* name, const char* summary, const char* label) {
  return {.name = name,
          .summary = summary,
          .knob = inextensible::Knob::time_step,
          .contestant = true,
          .settings = {},
          .make = nullptr,
          .label = label,
          .family = "engines",
          .takes_shear = false,
          .takes_collider = false,
          .takes_bending = false,
          .takes_drag = false,
          .takes_implicit_forces = false};
}

}  // namespace engines
