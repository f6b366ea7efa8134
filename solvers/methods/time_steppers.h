// The second axis of contestants: the time steppers that a method may stand in. A method enforces
// constraints or carries stiff springs; the stepper takes it from one state to the next.
#pragma once

#include <span>

#include "solvers/methods/backend.h"

namespace inextensible {

struct TimeStepper {
  const char* name;  // what follows the @
  std::unique_ptr<Stepper> (*around)(std::shared_ptr<const Problem>, const Backend& method,
                                     const BackendOptions&);
  Origin origin = Origin::paper;
  const char* citation = "";
  const char* phrase = "";  // after a method's label: "in BDF2"; empty for a published stepper
  Velocities velocities = Velocities::half_step;
  Along along = Along::edges;  // where corrections of a filter point
  bool takes_implicit_forces = true;
  std::vector<SettingInfo> settings = {};  // the stepper's own
};

std::span<const TimeStepper> time_steppers();

// Why the pair makes no sense, as the end of a sentence; null: it does.
const char* mismatch(const Backend& method, const TimeStepper& stepper);

}  // namespace inextensible
