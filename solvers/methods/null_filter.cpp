// Registered as `null`, no contestant: the unconstrained step alone, to measure what the scene and
// the harness cost.
#include "solvers/methods/rows.h"
#include "solvers/stepping/velocity_filter.h"

namespace inextensible {
namespace {

class Unconstrained final : public VelocityFilter {
 public:
  StepResult apply(const Positions& /*x_start*/, double /*h*/, Iterate /*x*/,
                   WorkCounters& /*work*/) override {
    return {};
  }
};

}  // namespace

Backend null_row() {
  return {.name = "null",
          .summary = "unconstrained step only: what the scene and the harness cost",
          .strain_control = StrainControl::none,
          .contestant = false,
          .settings = {},
          .make_filter = [](const Problem&, const BackendOptions&, Along)
              -> std::unique_ptr<VelocityFilter> { return std::make_unique<Unconstrained>(); },
          .label = "scene without inextensibility"};
}

}  // namespace inextensible
