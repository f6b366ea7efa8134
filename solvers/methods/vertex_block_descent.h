// Vertex block descent (Chen, Liu, Yang and Yuksel 2024): the implicit springs' energy, backward
// Euler's, lowered by a given number of passes that move one vertex at a time. It has no strain
// limit of its own, as they have none; and as passes end before the minimum, less stiffness than
// asked for is what shows.
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/methods/vertex_passes.h"

namespace inextensible {

class VertexBlockDescent final : public Stepper {
 public:
  struct Settings {
    double stiffness = 1e4;  // EA, N; as ImplicitSprings'
    int iterations = 100;    // passes a step
    double relaxation = 1;   // times a vertex's move
  };
  static SettingFields<Settings> fields();
  VertexBlockDescent(std::shared_ptr<const Problem> problem, const Settings& settings);

 private:
  StepResult solve(const State& state, double h, Positions& x) override;
  void start(const State& state, double h, Positions& x) const;
  StepResult end_velocities(const State& before, double h, const Positions& filtered,
                            const Positions& x, Positions& v) override;

  int iterations_;
  double relaxation_;
  VertexPasses passes_;
  Positions inertial_;           // x + h v + h^2 g, drag's included
  std::vector<double> inertia_;  // m + h times drag, kg
  Positions v_before_;           // v^{n-1}
  double h_before_ = 0;          // s; 0: no step yet
};

Backend vertex_block_descent_row();

}  // namespace inextensible
