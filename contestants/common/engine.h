// What the rows of all engines share.
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>

#include "solvers/methods/rows.h"
#include "solvers/problem/stopwatch.h"

namespace engines {

// Throws std::invalid_argument for pins that move. An Engine has settings() and a `name`.
template <class Engine>
std::unique_ptr<inextensible::Stepper> make_engine(
    std::shared_ptr<const inextensible::Problem> problem,
    const inextensible::BackendOptions& options) {
  if (problem->pins_follow_body())
    throw std::invalid_argument(std::string("solver '") + Engine::name +
                                "' takes no pins that move");
  return std::make_unique<Engine>(std::move(problem), options);
}

// A row with what engines do not take; `summary` and `label` name the engine and its version, and
// must outlive the row.
template <class Engine>
inextensible::Backend engine_row(const std::string& summary, const std::string& label) {
  return {.name = Engine::name,
          .summary = summary.c_str(),
          .strain_control = inextensible::StrainControl::time_step,
          .contestant = true,
          .settings = Engine::settings(),
          .make = make_engine<Engine>,
          .origin = inextensible::Origin::engine,
          .label = label.c_str(),
          .family = "engines",
          .takes_shear = false,
          .takes_collider = false,
          .takes_bending = false,
          .takes_drag = false,
          .takes_implicit_forces = false};
}

}  // namespace engines
