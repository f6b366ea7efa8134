// Registered as `null`, no contestant: the unconstrained step alone, to measure what the scene and
// the harness cost.
#pragma once

#include "solvers/methods/backend.h"
#include "solvers/stepping/velocity_filter.h"

namespace inextensible {

class Unconstrained final : public VelocityFilter {
 public:
  explicit Unconstrained(const Problem& /*problem*/) {}
  StepResult apply(const Positions& /*x_start*/, double /*h*/, Iterate /*x*/,
                   WorkCounters& /*work*/) override {
    return {};
  }
};

Backend null_row();

}  // namespace inextensible
