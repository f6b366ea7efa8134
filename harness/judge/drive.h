// Drives a scene: where a method starts it, and its steps to the end, for any observer.
#pragma once

#include <concepts>

#include "harness/base/clock.h"
#include "harness/base/interrupt.h"
#include "harness/points/point.h"
#include "solvers/stepping/step_controller.h"
#include "solvers/systems/constrained_acceleration.h"

namespace harness {

// Where a method begins to take steps of h: half a step back if its velocities are mid-step ones.
inline State start_from(const Problem& problem, const State& state, const Backend& backend,
                        double h) {
  const bool half_step = backend.velocities == Velocities::half_step;
  return half_step ? inextensible::start_half_step_back(problem, state, h) : state;
}
// The same from the scene's start, where the scene asks for that.
inline State start_of(const Scene& scene, const Backend& backend, double h) {
  return scene.staggered ? start_from(*scene.problem, scene.start, backend, h) : scene.start;
}

struct Pace {
  double step;       // s
  long steps;        // of a drive
  int halvings = 0;  // how often a step that is refused may be halved
};

struct DriveLimits {
  double timeout = std::numeric_limits<double>::infinity();  // s of wall time, since `begin`
  Clock::time_point begin = Clock::now();
  std::function<bool()> interrupted = nullptr;
};

// A drive so far, and how it ended.
struct DriveState {
  enum class End { arrived, stopped, refused, timed_out };
  End end = End::arrived;
  long steps = 0;               // of the pace, whole ones
  bool whole = true;            // the last one taken ends such a step
  int taken = 0;                // whole or halved, since `before`
  StepResult result = {};       // of the last one
  double last, smallest, next;  // s, of those taken and of the next one
};

// Observes a drive; a derived class hides the functions that it needs.
struct Observer {
  // How many steps to take before `after`. May change the state.
  int before(State& /*state*/, const DriveState& /*driven*/) { return 1; }
  // After each of them; after all of them, and after a refusal.
  void each(const State& /*state*/, const DriveState& /*driven*/) {}
  void all(const State& /*state*/, const DriveState& /*driven*/) {}
  // Not after a refusal. Whether to go on.
  bool after(const State& /*state*/, const DriveState& /*driven*/) { return true; }
};

// Takes the steps of a pace from a state on, up to a refusal, which leaves the state as it was. The
// limits are looked at after each `after`. Throws Interrupted.
template <std::derived_from<Observer> O>
DriveState drive(Stepper& stepper, State& state, const Pace& pace, O& observer,
                 const DriveLimits& limits = {}) {
  using inextensible::StepController;
  std::optional<StepController> controller;
  if (pace.halvings > 0)
    controller.emplace(
        stepper, StepController::Settings{.largest = pace.step,
                                          .most_halvings = pace.halvings,
                                          .energy_bound = std::numeric_limits<double>::infinity()});
  DriveState driven{.last = pace.step, .smallest = pace.step, .next = pace.step};
  while (driven.steps < pace.steps) {
    const int block = observer.before(state, driven);
    for (driven.taken = 0; driven.taken < block && driven.steps < pace.steps; ++driven.taken) {
      driven.result = controller ? controller->advance(state) : stepper.advance(state, pace.step);
      if (!driven.result) break;
      driven.whole = !controller || controller->aligned();
      if (driven.whole) ++driven.steps;
      observer.each(state, driven);
    }
    observer.all(state, driven);
    if (controller) {
      driven.last = controller->last();
      driven.smallest = controller->smallest();
      driven.next = controller->next();
    }
    if (!driven.result)
      driven.end = DriveState::End::refused;
    else if (!observer.after(state, driven))
      driven.end = DriveState::End::stopped;
    else if (limits.interrupted && limits.interrupted())
      throw Interrupted();
    else if (driven.steps < pace.steps && since(limits.begin) > limits.timeout)
      driven.end = DriveState::End::timed_out;
    else
      continue;
    break;
  }
  return driven;
}

inline DriveState drive(Stepper& stepper, State& state, const Pace& pace,
                        const DriveLimits& limits = {}) {
  Observer none;
  return drive(stepper, state, pace, none, limits);
}

// With a function as the observer: called after each step, it returns whether to go on.
template <std::predicate<const State&, const DriveState&> After>
DriveState drive(Stepper& stepper, State& state, const Pace& pace, After after,
                 const DriveLimits& limits = {}) {
  struct Calling : Observer {
    After& call;
    explicit Calling(After& a) : call(a) {}
    bool after(const State& now, const DriveState& driven) { return call(now, driven); }
  } observer(after);
  return drive(stepper, state, pace, observer, limits);
}

}  // namespace harness
