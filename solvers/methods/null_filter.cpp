#include "solvers/methods/null_filter.h"

namespace inextensible {

Backend null_row() {
  return {.name = "null",
          .summary = "unconstrained step only: what the scene and the harness cost",
          .knob = Knob::none,
          .contestant = false,
          .settings = {},
          .make = [](std::shared_ptr<const Problem> problem,
                     const BackendOptions&) -> std::unique_ptr<Stepper> {
            auto filter = std::make_unique<Unconstrained>(*problem);
            return std::make_unique<FilterStepper>(std::move(problem), std::move(filter));
          },
          .label = "scene without inextensibility"};
}

}  // namespace inextensible
