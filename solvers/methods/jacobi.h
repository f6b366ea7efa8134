// Jacobi strain limiting (Provot 1995; Bridson, Fedkiw and Anderson 2002): all edges corrected from
// the same state, the corrections averaged, until the maximum strain is permissible.
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class Jacobi final : public VelocityFilter {
 public:
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 100000;  // sweeps a step
    double target = 0;            // a corrected edge aims at |strain| = target * strain_limit
    double relaxation = 1.8;      // 1: the plain average; converges below 2
  };
  static SettingFields<Settings> fields();
  Jacobi(const Problem& problem, const Settings& settings);
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

Backend jacobi_row();

}  // namespace inextensible
