// Takes any backend through steps that it refuses: halves the step, and doubles it after successes.
//
// Steps are largest / 2^k and begin at multiples of themselves, so that every multiple of `largest`
// is met exactly, whatever happened in between.
//
// Methods may meet every strain limit and yet add energy in steps that are too long, for instance
// where a heavy weight swings on light links. What steps add from the second on, where neither the
// caller moves pins nor a body moves, is therefore bounded.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "solvers/problem/forces.h"
#include "solvers/stepping/stepper.h"

namespace inextensible {

class StepController {
 public:
  struct Settings {
    double largest = 1.0 / 25;  // s, > 0
    int most_halvings = 14;     // below largest / 2^14 it gives up; 0 to 30
    int patience = 4;           // accepted steps of one size before the next larger one is tried
    // Energy that steps may add, over weight times size and the kinetic energy at first; infinite:
    // any. Long steps of a method that works add up to half as much for a while, where a heavy end
    // is caught in its swing, and lose it again; what blows up soon passes any bound.
    double energy_bound = 0.5;
  };
  // The stepper must outlive the controller and take no other steps meanwhile.
  StepController(Stepper& stepper, const Settings& settings)
      : stepper_(stepper), settings_(settings), smallest_(settings.largest) {
    if (!(settings.largest > 0) || !std::isfinite(settings.largest))
      throw std::invalid_argument("step controller: the largest step must be positive and finite");
    if (settings.most_halvings < 0 || settings.most_halvings > 30)
      throw std::invalid_argument("step controller: 0 to 30 halvings");
  }

  // Takes one step of next() seconds, which it may have to shorten first. A refusal is the one at
  // the smallest step, and leaves the state untouched. Refused attempts are in the stepper's
  // counter rejected_steps.
  StepResult advance(State& state) {
    const bool bounded = std::isfinite(settings_.energy_bound) && !stepper_.problem().body_motion();
    if (bounded) begin_energy(state);
    for (;;) {
      const double h = next();
      const StepResult result = stepper_.advance(state, h);
      if (!result) {
        successes_ = 0;
        if (halvings_ == settings_.most_halvings) return result;
        ++halvings_;
        continue;
      }
      if (bounded && gains_energy(state)) {
        state = before_;
        return {Status::gained_energy, result.iterations, -1, 0,
                "steps add energy; a smaller `largest` may not"};
      }
      last_ = h;
      smallest_ = std::min(smallest_, h);
      const std::int64_t whole = std::int64_t{1} << settings_.most_halvings;
      place_ = (place_ + ticks()) % whole;
      if (++successes_ >= settings_.patience && halvings_ > 0 && place_ % (2 * ticks()) == 0) {
        --halvings_;
        successes_ = 0;
      }
      return result;
    }
  }

  // s: of the last accepted step; of the smallest accepted one; of the next attempt.
  double last() const { return last_; }
  double smallest() const { return smallest_; }
  double next() const { return std::ldexp(settings_.largest, -halvings_); }
  // Whether the accepted steps add up to a multiple of `largest`.
  bool aligned() const { return place_ == 0; }

 private:
  std::int64_t ticks() const { return std::int64_t{1} << (settings_.most_halvings - halvings_); }

  double energy(const State& state) const {
    return potential_energy(stepper_.problem(), state.x) +
           kinetic_energy(stepper_.problem(), state.v);
  }

  void begin_energy(const State& state) {
    const Problem& problem = stepper_.problem();
    const auto moved = [&](int pin) { return state.x.col(pin) != before_.x.col(pin); };
    if (before_.x.cols() != state.x.cols() || std::ranges::any_of(problem.pinned(), moved)) {
      const double size = (state.x.rowwise().maxCoeff() - state.x.rowwise().minCoeff()).norm();
      allowed_ = settings_.energy_bound * (problem.total_mass() * problem.gravity().norm() *
                                               std::max(size, problem.longest_rest_length()) +
                                           kinetic_energy(problem, state.v));
      gained_ = -std::numeric_limits<double>::infinity();  // before the first step
    }
    before_ = state;
  }

  bool gains_energy(const State& state) {
    gained_ = std::isfinite(gained_) ? gained_ + energy(state) - energy(before_) : 0;
    return gained_ > allowed_;
  }

  Stepper& stepper_;
  Settings settings_;
  int halvings_ = 0;
  int successes_ = 0;       // at this size
  std::int64_t place_ = 0;  // within the largest step, in units of the smallest
  double last_ = 0, smallest_;
  State before_;                     // the last step
  double allowed_ = 0, gained_ = 0;  // energy, J, since pins last moved
};

}  // namespace inextensible
