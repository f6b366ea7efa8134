// A constraint method as a filter of velocities, and the stepper that such a filter makes.
#pragma once

#include <memory>

#include "solvers/problem/contacts.h"
#include "solvers/stepping/stepper.h"
#include "solvers/systems/implicit_forces.h"

namespace inextensible {

// Where a filter's corrections point: along the edges as they are, or along their middles between
// the start of the step and now. An edge turned by more than 90 degrees is corrected along itself.
enum class Along { edges, middle };

// Takes start-of-step and candidate positions, moves the candidate onto the constraint manifold.
class VelocityFilter {
 public:
  VelocityFilter() = default;
  virtual ~VelocityFilter() = default;
  VelocityFilter(const VelocityFilter&) = delete;
  VelocityFilter& operator=(const VelocityFilter&) = delete;

  // x_start = x^n and x = x0 (both 3 x n; in another round for new contacts, the last one's result)
  // in, x = x^{n+1} out; the filtered velocity is (x - x_start) / h. On refusal x is unspecified.
  // Pinned vertices keep their place bit for bit, and another settle() would change nothing.
  virtual StepResult apply(const Positions& x_start, double h, Iterate x, WorkCounters& work) = 0;

  virtual const char* linear_solver() const { return ""; }
  void observe(IterateObserver* observer) { observer_ = observer; }

 protected:
  IterateObserver* observer_ = nullptr;
};

// Repeats the filter until no vertex is inside the obstacle. contacts: null, or begun.
StepResult apply_until_clear(VelocityFilter& filter, Contacts* contacts, const Positions& x_start,
                             double h, Positions& x, WorkCounters& work);

// An unconstrained step, then the filter. Here the pipeline of the paper's section 4.4,
// v* = v - h W grad V(x), x0 = x + h v*, with V explicit or, where the problem asks for it
// and the step is too long for that, implicit (ImplicitForces).
class FilterStepper : public Stepper {
 public:
  FilterStepper(std::shared_ptr<const Problem> problem, std::unique_ptr<VelocityFilter> filter);
  const char* linear_solver() const override { return filter_->linear_solver(); }
  void observe(IterateObserver* observer) override { filter_->observe(observer); }

 protected:
  // Writes x0, in which pinned vertices are those of `state`. false: the system of implicit forces
  // is singular.
  virtual bool unconstrained(const State& state, double h, Positions& x0);

  std::unique_ptr<ImplicitForces> implicit_;  // null: V always explicit

 private:
  StepResult solve(const State& state, double h, Positions& x) final;

  std::unique_ptr<VelocityFilter> filter_;
};

}  // namespace inextensible
