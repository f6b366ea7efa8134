// Plug-ins that bench must refuse, by MISFIT_..., one that it must find broken (plugin_test.sh
// loads them), and one that never ends a step (interrupts_test.sh).
#include <unistd.h>

#include <stdexcept>

#include "solvers/plugin.h"

namespace {

using namespace inextensible;

struct Nothing final : VelocityFilter {
  StepResult apply(const Positions&, double, Iterate, WorkCounters&) override {
#if defined(MISFIT_hangs)
    for (;;) pause();
#endif
    return {};
  }
};

std::unique_ptr<Stepper> make(std::shared_ptr<const Problem> problem, const BackendOptions&) {
  return std::make_unique<FilterStepper>(std::move(problem), std::make_unique<Nothing>());
}

#if defined(MISFIT_taken_name)
constexpr const char* name = "shake";
#else
constexpr const char* name = "misfit";
#endif

}  // namespace

extern "C" const InextensiblePlugin* inextensible_plugin() {
  static const std::vector<Backend> rows{
      {name, "does nothing", StrainControl::strain_limit, true, {}, make}};
  static InextensiblePlugin plugin = inextensible_plugin_of("1.0", rows);
#if defined(MISFIT_another_version)
  plugin.abi = 999;
#elif defined(MISFIT_throws)
  throw std::runtime_error("no licence\nfor today");
#endif
  return &plugin;
}
