// What the strain limiters that make passes over edges share: their settings, and the filter.
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"

namespace inextensible {

struct LimiterSettings {  // What each is for stands in fields().
  double strain_limit = 0.01;
  int max_iterations = 100000;
  double target = 0;
  double relaxation = 1;
  std::uint64_t seed = 1;
  static SettingFields<LimiterSettings> fields() {
    using S = LimiterSettings;
    return {
        {"max_iterations", &S::max_iterations, "passes a step before it is refused", at_least_one},
        {"target", &S::target, "a corrected edge is brought to this fraction of the strain limit",
         fraction, tunable_fraction},
        {"relaxation", &S::relaxation, "times the correction", relaxation_range,
         tunable_relaxation}};
  }
};

// Passes over colored edges until one finds nothing to correct.
template <StrainPasses::Order order>
class PassLimiter : public VelocityFilter {
 public:
  using Settings = LimiterSettings;
  static SettingFields<Settings> fields() { return Settings::fields(); }
  StepResult apply(const Positions& x_start, double /*h*/, Iterate x, WorkCounters& work) override {
    if (along_ == Along::middle) passes_.take_middle_from(x_start);
    return passes_.limit(order, max_iterations_, edges_, x, work);
  }

 protected:
  PassLimiter(const Problem& problem, const Settings& settings, StrainPasses passes, Along along)
      : edges_(problem, settings.strain_limit),
        max_iterations_(settings.max_iterations),
        along_(along),
        passes_(std::move(passes)) {}

 private:
  EdgeConstraints edges_;
  int max_iterations_;
  Along along_;
  StrainPasses passes_;
};

}  // namespace inextensible
