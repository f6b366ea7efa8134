// Strips (Bender and Bayer 2008, "Parallel simulation of inextensible cloth"): every thread of the
// cloth is projected as a whole, warp after weft, and some sweeps over all edges mend between two
// such passes what couples them.
#pragma once

#include <memory>

#include "inextensible/methods/setting_fields.h"
#include "inextensible/methods/strain_pass.h"
#include "inextensible/methods/threads.h"

namespace inextensible {

class Strips final : public VelocityFilter {
 public:
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 5000;  // passes over all threads, a step
    int sweeps = 20;            // between two passes; none where threads share no vertex
    double relaxation = 1.8;    // of a sweep's correction
    // Links strained beyond this fraction of the limit are brought to it, in a thread that has one
    // beyond the limit; a sweep brings its edges to `sweep_target`.
    // At 0 over-relaxed sweeps throw edges to the other side of the band, and runs gain energy.
    double target = 0.8;
    double sweep_target = 0.8;
  };
  static SettingFields<Settings> fields();
  Strips(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Positions& x, WorkCounters& work) override;

 private:
  static constexpr int lanes = 8;
  // Threads of one color side by side, one a lane; shorter ones end in links that are none.
  struct Bundle {
    int links, first, threads;  // first: row of vertices and links in the arrays below
  };
  void add_bundle(const Problem& problem, const std::vector<const Thread*>& threads);
  template <int used>
  std::int64_t project(const Bundle& bundle, WorkCounters& work);

  EdgeConstraints edges_;
  int max_iterations_, sweeps_;
  StrainBand band_;
  double target_low_, target_high_;  // of q - 1 = |d|^2 / l^2 - 1
  StrainSweep sweep_;
  std::vector<Bundle> bundles_;
  // Rows of `lanes` numbers. Of vertices: place in the sweep's positions, inverse mass; of the link
  // to the next vertex: rest length and its inverse (0: no link).
  std::vector<int> place_;
  std::vector<double> inverse_mass_, rest_, inverse_rest_;
  struct Row {
    alignas(64) double g[3][lanes];  // d / l of a link
    alignas(64) double off[lanes];   // coupling with the link before
    alignas(64) double inverse_pivot[lanes];
    alignas(64) double c[lanes];  // right-hand side, then the multiplier
  };
  std::vector<Row> rows_;  // the first is zero: no link comes before
};

Backend strips_row();
// The same inside BDF2 (bdf2_stepper.h).
Backend strips_bdf2_row();

}  // namespace inextensible
