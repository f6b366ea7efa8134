// Gauss-Seidel strain limiting (Bridson, Fedkiw and Anderson 2002; Mueller et al. 2006): edge after
// edge, in a fresh random permutation each pass (Goldenthal et al. 2007, section 5), until the
// maximum strain is permissible.
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/strain_passes.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class GaussSeidel final : public VelocityFilter {
 public:
  // What each is for stands in fields().
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 100000;
    double target = 0;
    double relaxation = 1;
    std::uint64_t seed = 1;
  };
  static SettingFields<Settings> fields();
  GaussSeidel(const Problem& problem, const Settings& settings, Along along = Along::edges);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;

 private:
  struct EdgeRecord {  // all that a visit needs
    int a, b;
    double inverse_square;  // 1 / l^2
    double share_a;         // w_a / (w_a + w_b), of the correction
  };
  void shuffle();
  template <bool middle>
  std::int64_t pass(const Positions& x_start, Positions& x) const;

  EdgeConstraints edges_;
  int max_iterations_;
  StrainBand band_;
  double relaxation_;
  Along along_;
  std::vector<EdgeRecord> records_;
  std::vector<int> permutation_;
  std::uint64_t random_;  // SplitMix64 state
};

Backend gauss_seidel_row();

}  // namespace inextensible
