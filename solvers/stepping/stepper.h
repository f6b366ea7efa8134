// What every backend offers: advance a state by h, or refuse and leave it bit for bit as it was.
//
// A step is: positions that are inextensible and, where the problem asks for contact inside, out of
// the obstacle; a collision filter, which moves out what is still inside; then
// v = (x^{n+1} - x^n) / h. Constraint methods are velocity filters behind one unconstrained step; a
// method that treats stretching inside its time stepper derives from Stepper directly.
#pragma once

#include <memory>

#include "solvers/problem/contacts.h"
#include "solvers/problem/step_result.h"
#include "solvers/problem/work_counters.h"

namespace inextensible {

class EdgeConstraints;

// contact: what of the first three goes to friction, to finding contacts and to planes, without the
// iterations that these cost. copy: into an engine's state and out of it; not in the others.
struct PhaseSeconds {
  double unconstrained = 0, filter = 0, collision = 0, contact = 0, copy = 0;
};

// Sees the iterates of a step, where a method shows them: for measurements, not for the method.
class IterateObserver {
 public:
  virtual ~IterateObserver() = default;
  // x_j, from the candidate x_0 on, and the multipliers h^2 lambda_j so far, one an edge.
  virtual void iterate(const EdgeConstraints& edges, int j, const Positions& x,
                       const Eigen::VectorXd& multipliers) = 0;
};

class Stepper {
 public:
  // own_contacts: false for a stepper around another one, which looks after contacts.
  explicit Stepper(std::shared_ptr<const Problem> problem, bool own_contacts = true);
  virtual ~Stepper() = default;
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  // Advances `state` (shapes as the problem's, finite) by h > 0 seconds. On refusal the state is
  // untouched. After the first call only library factorizations allocate. Energy is not looked at:
  // a step that meets every limit may add some, which StepController bounds.
  StepResult advance(State& state, double h);

  // Positions of the last accepted step after the inextensibility filter and before the collision
  // filter: where strain is measured. Meaningful until the next call of advance.
  virtual const Positions& filtered_positions() const {
    return contacts_ && !contacts_->clear() ? filtered_ : next_;
  }
  // The contacts of the last step; null without a collider.
  const Contacts* contacts() const { return contacts_.get(); }

  const Problem& problem() const { return *problem_; }
  const WorkCounters& work() const { return work_; }
  // Seconds spent in each phase of the steps since measure_phases(true); it is off at first.
  const PhaseSeconds& phases() const { return phases_; }
  void measure_phases(bool wanted);
  // The linear solver in use, "" for methods without one.
  virtual const char* linear_solver() const { return ""; }
  // From the next step on; null: none. Methods that show no iterates do nothing. The observer
  // outlives the stepper, or is unregistered first.
  virtual void observe(IterateObserver* /*observer*/) {}

 protected:
  // Writes the inextensible positions at the end of the step to x; adds to work_ and phases_. Pins
  // that follow the body are, in `state`, where they end the step, without velocity: methods treat
  // them as if they never moved.
  virtual StepResult solve(const State& state, double h, Positions& x) = 0;

  // Writes the velocities at the end of the step to v, from the positions x after the collision
  // filter. One-step methods take v = (x - x^n) / h. A method that remembers earlier steps does so
  // here; it may still refuse.
  virtual StepResult end_velocities(const State& start, double h, const Positions& x, Positions& v);

  // Where all vertices, pins that follow the body as well, are at the start of the step.
  const Positions& start_positions() const { return *start_; }

  std::shared_ptr<const Problem> problem_;
  WorkCounters work_;
  PhaseSeconds phases_;
  bool phases_wanted_ = false;  // for Stopwatch
  // Contacts of the present step; null without a collider.
  std::unique_ptr<Contacts> contacts_;
  // The same where methods take them into account, else null.
  Contacts* contacts_inside() const {
    return problem_->contact_inside() ? contacts_.get() : nullptr;
  }

 private:
  StepResult attempt(State& state, double h);  // advance() without its counters
  const State& with_pins_at_end(const State& state, double h);

  Positions next_, filtered_, velocity_;
  const Positions* start_ = nullptr;  // of the present step
  State moved_;                       // what with_pins_at_end returns where pins follow the body
};

}  // namespace inextensible
