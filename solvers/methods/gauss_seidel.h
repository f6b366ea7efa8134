// Gauss-Seidel strain limiting (Bridson, Fedkiw and Anderson 2002; Mueller et al. 2006): edge after
// edge, in a fresh random permutation each sweep (Goldenthal et al. 2007, section 5), until the
// maximum strain is permissible.
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class GaussSeidel final : public VelocityFilter {
 public:
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 100000;  // sweeps a step
    double target = 0;            // a corrected edge is brought to |strain| = target * strain_limit
    double relaxation = 1;        // of that correction; 1: Gauss-Seidel, above: over-relaxation
    std::uint64_t seed = 1;
  };
  static SettingFields<Settings> fields();
  GaussSeidel(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Positions& x, WorkCounters& work) override;

 private:
  struct EdgeRecord {  // all that a visit needs
    int a, b;
    double inverse_square;  // 1 / l^2
    double share_a;         // w_a / (w_a + w_b), of the correction
  };
  void shuffle();
  std::int64_t sweep(Positions& x) const;

  EdgeConstraints edges_;
  int max_iterations_;
  StrainBand band_;
  double relaxation_;
  std::vector<EdgeRecord> records_;
  std::vector<int> permutation_;
  std::uint64_t random_;  // SplitMix64 state
};

Backend gauss_seidel_row();

}  // namespace inextensible
