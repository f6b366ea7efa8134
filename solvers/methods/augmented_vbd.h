// Augmented vertex block descent (Giles, Diaz and Yuksel 2025) with hard lengths: the edges'
// multipliers are sought by the method of multipliers, and vertices moved one by one in between.
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/vertex_passes.h"
#include "solvers/systems/constraint_system.h"

namespace inextensible {

class AugmentedVbd final : public VelocityFilter {
 public:
  struct Settings {
    double strain_limit = 0.01;
    int max_iterations = 100000;  // passes a step
    double penalty = 10;          // stiffness of an edge, times 1 / (h^2 (w_a + w_b))
    // A step ends when no vertex moves by more than this times strain_limit times the shortest rest
    // length, over the penalty: an edge answers a move of its ends by that times it.
    double direction_tolerance = 1;
  };
  static SettingFields<Settings> fields();
  AugmentedVbd(const Problem& problem, const Settings& settings);
  StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) override;

 private:
  const Problem& problem_;
  EdgeConstraints edges_;
  double strain_limit_;
  int max_iterations_;
  double most_;  // m, that vertices move in the last pass
  VertexPasses passes_;
  Positions target_;        // the candidate without what planes pushed it
  Eigen::ArrayXd tension_;  // of the last accepted step, N, by the passes' entries
};

Backend augmented_vbd_row();

}  // namespace inextensible
