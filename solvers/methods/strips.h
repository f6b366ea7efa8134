// Strips (Bender and Bayer 2008, "Parallel simulation of inextensible cloth"): every yarn of the
// cloth is projected as a whole, all yarns of one color (warp or weft, on a grid) before the next.
// Departures from the paper: one Newton step on positions for each yarn, and colored Gauss-Seidel
// passes over all edges between two rounds.
#pragma once

#include <memory>

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/methods/yarn_pass.h"

namespace inextensible {

class Strips final : public VelocityFilter {
 public:
  // What each is for stands in fields(). With targets of 0, over-relaxed passes throw edges to the
  // other side of the band, and runs gain energy.
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 5000;
    int sweeps = 20;
    double relaxation = 1.8;
    double target = 0.8;
    double sweep_target = 0.8;
  };
  static SettingFields<Settings> fields();
  // Passes act along edges as they are.
  Strips(const Problem& problem, const Settings& settings, Along along = Along::edges);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;

 private:
  EdgeConstraints edges_;
  int max_iterations_;
  StrainPasses passes_;
  YarnPass yarns_;
  int passes_between_;
  Along along_;
};

Backend strips_row();

}  // namespace inextensible
