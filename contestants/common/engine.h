// What all engines share: how they are made, their rows, and how they step.
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

// A step of an engine: a state goes in, the engine steps, positions and velocities come out; the
// parts are timed.
class EngineStepper : public inextensible::Stepper {
 protected:
  using Positions = inextensible::Positions;
  using State = inextensible::State;
  using StepResult = inextensible::StepResult;

  explicit EngineStepper(std::shared_ptr<const inextensible::Problem> shared)
      : Stepper(std::move(shared)), v_(3, problem().vertices()) {
    if (problem().shear() || !problem().bending().empty() || problem().has_drag())
      forces_.resize(3, problem().vertices());
  }

 private:
  virtual StepResult put_in(const State& state, double h) = 0;
  // A force that is not the engine's own, on a vertex that is not pinned; N.
  virtual void give_force(int /*vertex*/, const Eigen::Vector3d& /*force*/) {}
  virtual StepResult step(double h) = 0;
  // Positions and velocities of the vertices that are not pinned.
  virtual void take_out(const State& start, Positions& x, Positions& v) = 0;
  // Updates what a refused step must leave as it was.
  virtual void accept(const Positions& /*x*/, const Positions& /*v*/) {}
  // Rebuilds the engine after an exception, when its state cannot be trusted.
  virtual void build() {}

  StepResult solve(const State& state, double h, Positions& x) final try {
    inextensible::Stopwatch stopwatch(phases_wanted_);
    const StepResult ready = put_in(state, h);
    if (!ready) return ready;
    phases_.copy += stopwatch();
    give_forces(state);
    phases_.unconstrained += stopwatch();
    const StepResult taken = step(h);
    phases_.filter += stopwatch();
    if (!taken) return taken;
    take_out(state, x, v_);
    for (const int pin : problem().pinned()) {
      x.col(pin) = state.x.col(pin);  // -0 stays -0
      v_.col(pin).setZero();
    }
    phases_.copy += stopwatch();
    return taken;
  } catch (const std::exception&) {
    build();
    return {inextensible::Status::not_converged, 0, -1, 0, "the engine gave up"};
  }

  // All but the weight, which is the engine's.
  void give_forces(const State& state) {
    if (forces_.size() == 0) return;
    forces_.setZero();
    add_forces(problem(), state.x, state.x, state.v, forces_, work_);
    for (int i = 0; i < problem().vertices(); ++i) {
      if (problem().inverse_mass()[i] > 0)
        give_force(i, forces_.col(i) - problem().mass()[i] * problem().gravity());
    }
  }

  StepResult end_velocities(const State& /*start*/, double /*h*/, const Positions& x,
                            Positions& v) final {
    v = v_;
    accept(x, v);
    return {};
  }

  Positions forces_;  // empty where a problem has none but the weight
  Positions v_;
};

}  // namespace engines
