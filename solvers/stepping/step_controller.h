// Takes any backend through steps that it refuses: halves the step, and doubles it after successes.
//
// Steps are largest / 2^k and begin at multiples of themselves, so that every multiple of `largest`
// is met exactly, whatever happened in between.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "solvers/stepping/stepper.h"

namespace inextensible {

class StepController {
 public:
  struct Settings {
    double largest = 1.0 / 25;  // s, > 0
    int most_halvings = 14;     // below largest / 2^14 it gives up; 0 to 30
    int patience = 4;           // accepted steps of one size before the next larger one is tried
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
    for (;;) {
      const double h = next();
      const StepResult result = stepper_.advance(state, h);
      if (!result) {
        successes_ = 0;
        if (halvings_ == settings_.most_halvings) return result;
        ++halvings_;
        continue;
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

  Stepper& stepper_;
  Settings settings_;
  int halvings_ = 0;
  int successes_ = 0;       // at this size
  std::int64_t place_ = 0;  // within the largest step, in units of the smallest
  double last_ = 0, smallest_;
};

}  // namespace inextensible
