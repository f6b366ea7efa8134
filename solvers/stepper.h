// What every backend offers: advance a state by h, or refuse and leave it bit for bit as it was.
//
// A step is: inextensible positions from the state (a backend's own business), then the collision
// filter, then v = (x^{n+1} - x^n) / h. Constraint methods are velocity filters behind one common
// unconstrained step; a method that treats stretching inside its time stepper (implicit springs)
// derives from Stepper directly.
#pragma once

#include <cstdint>
#include <memory>

#include "counters.h"
#include "problem.h"

namespace inextensible {

enum class Status {
  ok,
  not_converged,  // iteration limit, or no further progress
  singular,       // a linear system could not be solved
  not_finite,     // a number overflowed
};
const char* to_string(Status status);

struct StepResult {
  Status status = Status::ok;
  int iterations = 0;       // of the step
  int worst_edge = -1;      // refused steps: the problem's edge of largest strain, -1 if unknown
  double worst_strain = 0;  // its strain (infinite if not finite)
  const char* detail = "";  // refused steps: why, a literal

  explicit operator bool() const { return status == Status::ok; }
};

struct PhaseSeconds {
  double unconstrained = 0, filter = 0, collision = 0;
};

class Stepper {
 public:
  explicit Stepper(std::shared_ptr<const Problem> problem);
  virtual ~Stepper() = default;
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  // Advances `state` (shapes as the problem's, finite) by h > 0 seconds. On refusal the state is
  // untouched. Allocates nothing after the first call, but for what the library factorizations do
  // inside.
  StepResult advance(State& state, double h);

  // Positions of the last accepted step after the inextensibility filter and before the collision
  // filter: where strain is measured. Meaningful until the next call of advance.
  const Positions& filtered_positions() const { return problem_->collider() ? filtered_ : next_; }

  const Problem& problem() const { return *problem_; }
  const WorkCounters& work() const { return work_; }
  // Seconds spent in each phase of the steps since measure_phases(true); it is off at first.
  const PhaseSeconds& phases() const { return phases_; }
  void measure_phases(bool wanted) { phases_wanted_ = wanted; }
  // The linear solver in use, "" for methods without one.
  virtual const char* linear_solver() const { return ""; }
  // Of the last linear system that was factored, an estimate from its pivots; 1 for methods without
  // one. Meaningful after a step that counted a factorization and did not end `singular`.
  virtual double reciprocal_condition() const { return 1; }

 protected:
  // Writes the inextensible positions at the end of the step to x; adds to work_ and phases_.
  virtual StepResult solve(const State& state, double h, Positions& x) = 0;

  // Writes the velocities at the end of the step to v, from the positions x after the collision
  // filter; `filtered` are those before it, the same object where there is no collider. One-step
  // methods take v = (x - x^n) / h. A method that remembers earlier steps does so here; it may
  // still refuse.
  virtual StepResult end_velocities(const State& start, double h, const Positions& filtered,
                                    const Positions& x, Positions& v);

  std::shared_ptr<const Problem> problem_;
  WorkCounters work_;
  PhaseSeconds phases_;
  bool phases_wanted_ = false;  // for Lap

 private:
  Positions next_, filtered_, velocity_;
};

// A velocity filter: takes start-of-step and candidate positions, moves the candidate onto the
// constraint manifold.
class VelocityFilter {
 public:
  VelocityFilter() = default;
  virtual ~VelocityFilter() = default;
  VelocityFilter(const VelocityFilter&) = delete;
  VelocityFilter& operator=(const VelocityFilter&) = delete;

  // x_start = x^n and x = x0 (both 3 x n) in, x = x^{n+1} out; the filtered velocity is (x -
  // x_start) / h. On refusal x is unspecified. Pinned vertices keep their place bit for bit.
  virtual StepResult apply(const Positions& x_start, double h, Positions& x,
                           WorkCounters& work) = 0;

  virtual const char* linear_solver() const { return ""; }
  virtual double reciprocal_condition() const { return 1; }  // as the stepper's
};

// v* = v - h W grad V(x), x0 = x + h v*, filter: the pipeline of the paper's section 4.4 with V
// (gravity, shear) explicit.
class FilterStepper final : public Stepper {
 public:
  FilterStepper(std::shared_ptr<const Problem> problem, std::unique_ptr<VelocityFilter> filter);
  const char* linear_solver() const override { return filter_->linear_solver(); }
  double reciprocal_condition() const override { return filter_->reciprocal_condition(); }
  VelocityFilter& filter() { return *filter_; }

 private:
  StepResult solve(const State& state, double h, Positions& x) override;

  std::unique_ptr<VelocityFilter> filter_;
};

}  // namespace inextensible
