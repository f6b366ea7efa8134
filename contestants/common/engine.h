// What the rows of all engines share.
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>

#include "solvers/methods/setting_fields.h"
#include "solvers/problem/stopwatch.h"

namespace engines {

// Throws std::invalid_argument for pins that move. An Engine has Settings, fields() and a `name`;
// one whose model depends on the shape that the run starts from takes that as a third argument.
template <class Engine>
std::unique_ptr<inextensible::Stepper> make_engine(
    std::shared_ptr<const inextensible::Problem> problem,
    const inextensible::BackendOptions& options) {
  using Settings = typename Engine::Settings;
  if (problem->pins_follow_body())
    throw std::invalid_argument(std::string("solver '") + Engine::name +
                                "' takes no pins that move");
  const Settings settings = inextensible::settings_of<Engine>(options);
  if constexpr (std::is_constructible_v<Engine, decltype(problem), Settings,
                                        decltype(options.start)>)
    return std::make_unique<Engine>(std::move(problem), settings, options.start);
  else
    return std::make_unique<Engine>(std::move(problem), settings);
}

// A row with what engines do not take; `summary` and `label` name the engine and its version, and
// must outlive the row.
template <class Engine>
inextensible::Backend engine_row(const std::string& summary, const std::string& label) {
  return {.name = Engine::name,
          .summary = summary.c_str(),
          .strain_control = inextensible::StrainControl::time_step,
          .contestant = true,
          .settings = inextensible::setting_infos(Engine::fields()),
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
