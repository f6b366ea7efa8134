// Soft step, or TGS soft (Catto 2024): velocity constraints by Gauss-Seidel, positions by a spring
// of the step's own frequency, and a second stage that takes the spring's velocity away again. It
// promises no strain limit: strain falls as h^2, and the step is what buys it.
#pragma once

#include "solvers/methods/setting_fields.h"
#include "solvers/problem/edge_constraints.h"

namespace inextensible {

class SoftStep final : public Stepper {
 public:
  struct Settings {
    int passes = 1;           // over edges, of either stage
    double frequency = 0.25;  // of the springs, in 1/h
    double damping = 10;      // ratio, 1: critical
  };
  static SettingFields<Settings> fields();
  SoftStep(std::shared_ptr<const Problem> problem, const Settings& settings);

 private:
  StepResult solve(const State& state, double h, Positions& x) override;
  StepResult end_velocities(const State& start, double h, const Positions& filtered,
                            const Positions& x, Positions& v) override;
  void directions(const Positions& x);
  void pull(int k, double impulse, Positions& x) const;

  int passes_;
  double hardness_, give_, rate_;  // massScale, impulseScale and h times bias of the source
  EdgeConstraints edges_;
  Eigen::Matrix3Xd n_;          // of the edges; 0 where one has no length
  Eigen::VectorXd length_;      // m, at n_
  Eigen::VectorXd impulse_;     // of this step, kg m: h times impulse
  Eigen::VectorXd last_force_;  // of the last accepted step, N
};

Backend soft_step_row();

}  // namespace inextensible
