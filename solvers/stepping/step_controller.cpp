#include "solvers/stepping/step_controller.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace inextensible {

StepController::StepController(Stepper& stepper, const Settings& settings)
    : stepper_(stepper), settings_(settings), smallest_(settings.largest) {
  if (!(settings.largest > 0) || !std::isfinite(settings.largest))
    throw std::invalid_argument("step controller: the largest step must be positive and finite");
  if (settings.most_halvings < 0 || settings.most_halvings > 30)
    throw std::invalid_argument("step controller: 0 to 30 halvings");
}

double StepController::next() const { return std::ldexp(settings_.largest, -halvings_); }

StepResult StepController::advance(State& state) {
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

}  // namespace inextensible
