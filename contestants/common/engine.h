// What all engines share: how they are made, their rows, and forces that are not their own.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "solvers/methods/rows.h"
#include "solvers/plugin.h"
#include "solvers/problem/forces.h"
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

// The plug-in of one engine: its row with what engines do not take, completed by `complete`. The
// version names the engine; `kind` and `label` are what follows it in the summary and in figures.
template <class Engine, class Complete>
const InextensiblePlugin* plugin_of(const std::string& version, const std::string& kind,
                                    const std::string& label, const Complete& complete) {
  static const std::string name = version, summary = version + ", " + kind,
                           short_name = version + " " + label;
  static const std::vector<inextensible::Backend> rows = [&] {
    inextensible::Backend row{.name = Engine::name,
                              .summary = summary.c_str(),
                              .strain_control = inextensible::StrainControl::time_step,
                              .contestant = true,
                              .settings = Engine::settings(),
                              .make = make_engine<Engine>,
                              .origin = inextensible::Origin::engine,
                              .label = short_name.c_str(),
                              .family = "engines",
                              .takes_shear = false,
                              .takes_collider = false,
                              .takes_bending = false,
                              .takes_drag = false,
                              .takes_implicit_forces = false};
    complete(row);
    return std::vector{row};
  }();
  static const auto plugin = inextensible_plugin_of(name.c_str(), rows);
  return &plugin;
}

// All forces but the weight, for engines whose own gravity that is; N, in 3 x vertices. Empty where
// a problem has no others.
class OtherForces {
 public:
  explicit OtherForces(const inextensible::Problem& problem) : problem_(problem) {
    if (problem.shear() || !problem.bending().empty() || problem.has_drag())
      forces_.resize(3, problem.vertices());
  }

  // give(vertex, force), for each vertex that is not pinned.
  template <class Give>
  void give(const inextensible::State& state, inextensible::WorkCounters& work, const Give& give) {
    if (forces_.size() == 0) return;
    forces_.setZero();
    add_forces(problem_, state.x, state.v, forces_, work);
    for (int i = 0; i < problem_.vertices(); ++i) {
      if (problem_.inverse_mass()[i] > 0)
        give(i, Eigen::Vector3d(forces_.col(i) - problem_.mass()[i] * problem_.gravity()));
    }
  }

 private:
  const inextensible::Problem& problem_;
  inextensible::Positions forces_;
};

}  // namespace engines
