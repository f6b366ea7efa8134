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
  // What each is for stands in fields().
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 100000;
    double target = 0;
    double relaxation = 1;
  };
  static SettingFields<Settings> fields();
  GaussSeidelColored(const Problem& problem, const Settings& settings, Along along = Along::edges);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;

 private:
  EdgeConstraints edges_;
  int max_iterations_;
  Along along_;
  StrainPasses passes_;
};

Backend gauss_seidel_colored_row();

}  // namespace inextensible
