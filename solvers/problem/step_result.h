// How a step ended: done, or refused with the reason.
#pragma once

namespace inextensible {

enum class Status {
  ok,
  not_converged,  // iteration limit, or no further progress
  singular,       // a linear system could not be solved
  not_finite,     // a number overflowed
  gained_energy,  // steps lift or speed up what nothing drives (StepController)
};
inline const char* to_string(Status status) {
  constexpr const char* names[] = {"ok", "not_converged", "singular", "not_finite",
                                   "gained_energy"};
  return names[static_cast<int>(status)];
}

struct StepResult {
  Status status = Status::ok;
  int iterations = 0;       // of the step
  int worst_edge = -1;      // refused steps: the problem's edge of largest strain, -1 if unknown
  double worst_strain = 0;  // its strain (infinite if not finite)
  const char* detail = "";  // refused steps: why, a literal

  explicit operator bool() const { return status == Status::ok; }
};

}  // namespace inextensible
