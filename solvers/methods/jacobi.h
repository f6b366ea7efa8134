// Jacobi strain limiting (Provot 1995; Bridson, Fedkiw and Anderson 2002): all edges corrected from
// the same state, the corrections averaged, until the maximum strain is permissible.
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class Jacobi final : public VelocityFilter {
 public:
  // What each is for stands in fields().
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 100000;
    double target = 0;
    double relaxation = 1.8;
  };
  static SettingFields<Settings> fields();
  Jacobi(const Problem& problem, const Settings& settings, Along along = Along::edges);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;

 private:
  EdgeConstraints edges_;
  int max_iterations_;
  Along along_;
  StrainPasses passes_;
};

Backend jacobi_row();

}  // namespace inextensible
