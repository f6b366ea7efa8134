// Strips (Bender and Bayer 2008, "Parallel simulation of inextensible cloth"): every yarn of the
// cloth is projected as a whole, warp after weft, and some sweeps over all edges mend between two
// such passes what couples them.
#pragma once

#include <memory>

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/methods/yarn_pass.h"

namespace inextensible {

class Strips final : public VelocityFilter {
 public:
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 5000;  // passes over all yarns, a step
    int sweeps = 20;            // between two passes; none where yarns share no vertex
    double relaxation = 1.8;    // of a sweep's correction
    // Links strained beyond this fraction of the limit are brought to it, in a yarn that has one
    // beyond the limit; a sweep brings its edges to `sweep_target`.
    // At 0 over-relaxed sweeps throw edges to the other side of the band, and runs gain energy.
    double target = 0.8;
    double sweep_target = 0.8;
  };
  static SettingFields<Settings> fields();
  Strips(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Positions& x, WorkCounters& work) override;
  void heed(Contacts* contacts) override {
    VelocityFilter::heed(contacts);
    sweep_.heed(contacts);
    yarns_.heed(contacts);
  }

 private:
  EdgeConstraints edges_;
  int max_iterations_;
  StrainPasses sweep_;
  YarnPass yarns_;
  int sweeps_;
  Contacts::Record record_;  // with contacts only
};

Backend strips_row();
// The same inside BDF2 (bdf2_stepper.h).
Backend strips_bdf2_row();

}  // namespace inextensible
