// The second axis of contestants: the time steppers that a method may stand in. A method enforces
// constraints or carries stiff springs; the stepper takes it from one state to the next.
#pragma once

#include <span>

#include "solvers/methods/backend.h"

namespace inextensible {

struct TimeStepper {
  const char* name;    // what follows the @
  const char* phrase;  // after a method's label: "in BDF2"; empty for a published stepper
  const char* citation;
  Origin origin;
  Velocities velocities;
  Along along;  // where corrections of a filter point
  bool takes_implicit_forces;
  std::vector<SettingInfo> settings;  // the stepper's own
  std::unique_ptr<Stepper> (*around)(std::shared_ptr<const Problem>, const Backend& method,
                                     const BackendOptions&);
};

std::span<const TimeStepper> time_steppers();

// Why the pair makes no sense, as the end of a sentence; null: it does.
const char* mismatch(const Backend& method, const TimeStepper& stepper);

}  // namespace inextensible
