// Gauss-Seidel strain limiting in colors: as gauss_seidel, but edges that share no vertex are
// corrected side by side, as limiters for parallel processors do (Fratarcangeli, Tibaldo and
// Pellacini 2016).
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class GaussSeidelColored final : public VelocityFilter {
 public:
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 100000;  // sweeps a step
    double target = 0;            // a corrected edge is brought to |strain| = target * strain_limit
    double relaxation = 1;        // of that correction; 1: Gauss-Seidel, above: over-relaxation
  };
  static SettingFields<Settings> fields();
  GaussSeidelColored(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Positions& x, WorkCounters& work) override;
  void heed(Contacts* contacts) override {
    VelocityFilter::heed(contacts);
    sweep_.heed(contacts);
  }

 private:
  EdgeConstraints edges_;
  int max_iterations_;
  StrainPasses sweep_;
};

Backend gauss_seidel_colored_row();

}  // namespace inextensible
