// Methods from outside, behind the C interface (inextensible.h).
#pragma once

#include "solvers/inextensible.h"
#include "solvers/methods/backend.h"

namespace inextensible {

// A problem as the interface's flat arrays, which belong to it and to this.
struct SceneArrays {
  SceneArrays(const Problem& problem, const BackendOptions& options, Along along);
  SceneArrays(const SceneArrays&) = delete;
  SceneArrays& operator=(const SceneArrays&) = delete;

  void add_body(const Problem& problem);

  InextensibleScene scene{};
  State start;  // a copy: an object that is made anew is made like the first one
  std::vector<double> mass, drag, coefficients, stiffness;
  std::vector<std::int32_t> stencils;
};

// A time step from outside, in the interface's terms.
class ForeignStepper : public Stepper {
 public:
  using Stepper::Stepper;

 protected:
  // step: with h, time, x, v and pose of the state, which stays as it is. Phases and counters of
  // the step may be added.
  virtual StepResult take(const State& state, InextensibleStep& step) = 0;

 private:
  StepResult solve(const State& state, double h, Positions& x) final;
  StepResult end_velocities(const State& start, double h, const Positions& x, Positions& v) final;

  Positions v_, x_;  // what the method made of the state
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> pose_;
};

// Throws std::invalid_argument for a setting that makes no sense.
SettingInfo setting_of(const std::string& solver, const InextensibleSetting& setting);

// The row of a method, which lives until the program ends. Throws std::invalid_argument, saying
// why, for one that is incomplete or whose settings make no sense. add_backends checks its name.
Backend row_of(const InextensibleMethod& method);

}  // namespace inextensible
