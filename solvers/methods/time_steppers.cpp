#include "solvers/methods/backend.h"
#include "solvers/problem/forces.h"
#include "solvers/stepping/bdf2.h"

namespace inextensible {
namespace {

// A velocity filter inside the midpoint rule, for filters whose constraint forces act along the
// edges as they are in the middle of the step (Along::middle). With x0 = x^n + h v^n + h^2/2 W f,
//   x^{n+1} = x0 + h^2 / (1 + rho) W J(m)^T lambda,  m = (x^n + x^{n+1}) / 2,
//   v^{n+1} = v^n + h W f + h W J(m)^T lambda = v^n + h W f + (1 + rho) (x^{n+1} - x0) / h.
//
// C is quadratic, so J(m) (x^{n+1} - x^n) = C(x^{n+1}) - C(x^n) exactly: where lengths stay what
// they are, constraint forces do no work, and with rho = 1 energy and momentum are kept at any step
// (Simo and Tarnow 1992; Gonzalez 1999). With directions of the end of a step instead, as in
// Algorithm 1 of Goldenthal et al. 2007, they brake.
//
// rho, 0 to 1, is the spectral radius at infinite stiffness (Chung and Hulbert 1993): of a rate
// that constraints stop, -rho times as much is left after the step. So an edge that comes to its
// limit bounces there unless rho is less than 1. With 1 the rule is of second order; what is
// smaller acts on constraint forces alone. Vertices that an obstacle holds do not bounce
// (Contacts::end_velocity). f has shear and bending at x^n + h v^n / 2, drag at v^n;
// implicit forces join the constraint forces, with the same rho (ImplicitForces).
class MidpointStepper final : public FilterStepper {
 public:
  MidpointStepper(std::shared_ptr<const Problem> problem, std::unique_ptr<VelocityFilter> filter,
                  double spectral_radius)
      : FilterStepper(std::move(problem), std::move(filter)),
        rho_(spectral_radius),
        middle_(3, problem_->vertices()),
        candidate_(3, problem_->vertices()) {}

 private:
  bool unconstrained(const State& state, double h, Positions& x0) override {
    if (ImplicitForces* forces = in_step(implicit_, h))
      return forces->advance_inside(state, h, 1 / (1 + rho_), candidate_, x0, work_);
    const double scale = 0.5 * h * h;
    x0 = state.x + h * state.v;
    middle_ = 0.5 * (state.x + x0);
    add_acceleration(*problem_, middle_, scale, x0, work_);
    if (problem_->has_drag()) add_drag(*problem_, state.v, scale, x0);
    for (const int vertex : problem_->pinned()) x0.col(vertex) = state.x.col(vertex);
    candidate_ = x0;
    return true;
  }

  StepResult end_velocities(const State& start, double h, const Positions& x,
                            Positions& v) override {
    Stopwatch stopwatch(phases_wanted_);
    v = (2 * (candidate_ - start.x) + (1 + rho_) * (x - candidate_)) * (1 / h) - start.v;
    if (contacts_) {
      // Friction is a force of the candidate's, and no constraint's.
      const bool friction = contacts_->candidate().size() > 0;
      for (int contact = 0; contact < contacts_->count(); ++contact) {
        if (!contacts_->holds(contact)) continue;
        const int i = contacts_->vertex(contact);
        if (friction)
          v.col(i) += (1 - rho_) / h * (contacts_->candidate().col(i) - candidate_.col(i));
        v.col(i) = contacts_->end_velocity(contact, (x.col(i) - start.x.col(i)) / h, v.col(i));
      }
    }
    for (const int vertex : problem_->pinned()) v.col(vertex).setZero();
    phases_.unconstrained += stopwatch();
    return {};
  }

  double rho_;
  Positions middle_;     // x^n + h v^n / 2
  Positions candidate_;  // x0 before implicit forces
};

// BDF2 around a method that is a backward Euler step of its own (Choi and Ko 2002 take implicit
// springs in BDF2). With s = (x, v), the formula is that step over beta h from the state
// alpha s^n + (1 - alpha) s^{n-1}, whose time is (1 - beta) h after s^n.
class Bdf2OfEuler final : public Stepper {
 public:
  Bdf2OfEuler(std::shared_ptr<const Problem> problem, std::unique_ptr<Stepper> euler)
      : Stepper(std::move(problem), false),
        euler_(std::move(euler)),
        history_(*problem_),
        gravity_(problem_->gravity().replicate(1, problem_->vertices())) {
    for (Positions* p : {&ahead_.x, &ahead_.v}) p->resize(3, problem_->vertices());
  }

  const Positions& filtered_positions() const override { return euler_->filtered_positions(); }
  const char* linear_solver() const override { return euler_->linear_solver(); }

 private:
  StepResult solve(const State& state, double h, Positions& x) override {
    const auto& pinned = problem_->pinned();
    if (!history_.leads_to(state, h)) history_.restart(state, h, gravity_);
    const auto [now, before, beta_h] = history_.coefficients(h);
    ahead_.x = now * state.x + before * history_.x();
    ahead_.v = now * state.v + before * history_.v();
    ahead_.time = state.time + (h - beta_h);
    for (const int vertex : pinned) {
      ahead_.x.col(vertex) = start_positions().col(vertex);
      ahead_.v.col(vertex).setZero();
    }
    if (problem_->pins_follow_body()) {
      const BodyMotion& motion = problem_->body_motion();
      const Pose carry = motion(ahead_.time) * motion(state.time).inverse();
      for (const int vertex : pinned) ahead_.x.col(vertex) = carry(ahead_.x.col(vertex));
    }
    euler_->measure_phases(phases_wanted_);
    const StepResult result = euler_->advance(ahead_, beta_h);
    phases_ = euler_->phases();
    const WorkCounters own = work_;  // steps are those of the pair
    work_ = euler_->work();
    work_.steps = own.steps;
    work_.rejected_steps = own.rejected_steps;
    work_.iterations = own.iterations;
    x = ahead_.x;
    return result;
  }

  StepResult end_velocities(const State& start, double h, const Positions& x,
                            Positions& v) override {
    v = ahead_.v;
    history_.add_step(start, h, x, euler_->contacts(), v);
    return {};
  }

  std::unique_ptr<Stepper> euler_;
  Bdf2History history_;
  Positions gravity_;  // of every vertex
  State ahead_;        // alpha s^n + (1 - alpha) s^{n-1}, then s^{n+1}
};

using Made = std::unique_ptr<Stepper>;
using Shared = std::shared_ptr<const Problem>;

Made backward_euler(Shared problem, const Backend& method, const BackendOptions& options) {
  if (method.make) return method.make(std::move(problem), options);
  auto filter = method.make_filter(*problem, options, Along::edges);
  return std::make_unique<FilterStepper>(std::move(problem), std::move(filter));
}

Made bdf2(Shared problem, const Backend& method, const BackendOptions& options) {
  if (method.make) {
    auto one_step = method.make(problem, options);
    return std::make_unique<Bdf2OfEuler>(std::move(problem), std::move(one_step));
  }
  auto filter = method.make_filter(*problem, options, Along::edges);
  return std::make_unique<Bdf2Stepper>(std::move(problem), std::move(filter));
}

constexpr const char* spectral_radius = "spectral_radius";

Made midpoint(Shared problem, const Backend& method, const BackendOptions& options) {
  auto filter = method.make_filter(*problem, options, Along::middle);
  return std::make_unique<MidpointStepper>(std::move(problem), std::move(filter),
                                           options.number(spectral_radius));
}

}  // namespace

std::span<const TimeStepper> time_steppers() {
  static const std::vector<TimeStepper> all{
      {"backward_euler", backward_euler},
      // Symplectic where forces act along the start; by half-step velocities it is backward_euler.
      {"verlet", backward_euler, Origin::paper, "Verlet 1967"},
      {"bdf2", bdf2, Origin::literature, "Choi and Ko 2002; English and Bridson 2008", "in BDF2",
       Velocities::whole_step},
      {"midpoint",
       midpoint,
       Origin::literature,
       "Simo and Tarnow 1992; Gonzalez 1999",
       "in the midpoint rule",
       Velocities::whole_step,
       Along::middle,
       {{spectral_radius, 0.8,
         "what an edge keeps of its rate when it bounces off its limit; 1 conserves", Range{0, 1},
         SearchRange{0, 1}}}}};
  return all;
}

const char* mismatch(const Backend& method, const TimeStepper& stepper) {
  if (std::string_view(method.stepper) == stepper.name) return nullptr;
  if (!method.make_filter)
    return method.backward_euler && stepper.around == bdf2 ? nullptr
                                                           : "the method is a time step of its own";
  if (std::string_view(stepper.name) == "verlet")
    return "its forces act along the edges at the start of a step, the method's do not";
  if (method.direction == Direction::start)
    return "forces along the edges at the start of a step are of second order in its own stepper "
           "and of first order elsewhere";
  if (stepper.along == Along::middle && method.direction == Direction::end)
    return "the method's forces act along the edges at the end of a step, by definition; the "
           "stepper wants those of its middle";
  if (stepper.along == Along::middle && !method.takes_middle)
    return "the method corrects edges along themselves; the stepper wants their middles";
  return nullptr;
}

}  // namespace inextensible
