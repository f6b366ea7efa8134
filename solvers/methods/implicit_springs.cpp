// Implicit stiff springs (Baraff and Witkin 1998 and their kin): backward Euler with stretching as
// springs, as the minimum of an energy (spring_energy.h).
//
// Edge k has stiffness EA / l_k, so strain = tension / EA at any resolution. The method has no
// strain limit of its own: the harness finds the EA that keeps a run within the limit.
//
// Newton with a positive definite matrix always descends; backtracking on E. Three things make it
// cheap without changing E, its gradient, the descent test or the criterion to stop. (1) Newton
// starts at the lowest of the free flight, the start of the step, and its extrapolation to second
// order. (2) Tensions in the matrix are predicted. (3) Near the end a factorization is kept for
// further iterations while these shrink. Loops: one assembly, factorization and solve, and one or
// more energy evaluations, an iteration.
#include "solvers/methods/rows.h"
#include "solvers/methods/spring_energy.h"

namespace inextensible {
namespace {

constexpr double held = 1e-300;  // m: a push that says no more than that
constexpr int halving_limit = 30;
constexpr double armijo_fraction = 1e-4;
constexpr double rounding = 1e-14;
// What a step with an old factorization must shrink to, times the last: it then bounds its error.
constexpr double fast_convergence = 0.5;

class ImplicitSprings final : public Stepper {
 public:
  ImplicitSprings(std::shared_ptr<const Problem> shared, const BackendOptions& options)
      : Stepper(std::move(shared)),
        energy_(problem(), options.number("stiffness")),
        max_iterations_(options.count("max_iterations")),
        step_tolerance_(options.number("newton_tolerance") * options.strain_limit *
                        problem().shortest_rest_length()),
        reuse_below_(options.number("reuse") * step_tolerance_) {
    if (step_tolerance_ == 0) step_tolerance_ = 1e-12;  // no edge says what is small: rounding
    for (Positions* x : {&trial_, &ahead_, &v_before_}) x->resize(3, problem().vertices());
    if (problem().contact_inside()) released_.resize(problem().vertices());
  }
  const char* linear_solver() const override { return energy_.matrix().linear_solver.c_str(); }

 private:
  StepResult solve(const State& state, double h, Positions& x) override {
    Stopwatch stopwatch(phases_wanted_);
    energy_.begin(state, h);
    if (contacts_inside()) {
      contacts_->apply_friction(energy_.inertial(), work_);
      contacts_->find(energy_.inertial(), work_);
      std::fill(released_.begin(), released_.end(), Release::never);
      for (int c = 0; c < contacts_->count(); ++c) contacts_->set_push(c, held);
    }
    const double lowest = start(state, h, x);
    const StepResult result = newton(lowest, x);
    phases_.unconstrained += stopwatch();
    return result;
  }

  void count_evaluations() { work_.spring_evaluations += energy_.springs(); }

  // Where Newton starts, to x; returns its energy. Whatever the history is, the start is never
  // higher than the free flight and the start of the step.
  double start(const State& state, double h, Positions& x) {
    double lowest = std::numeric_limits<double>::infinity();
    const auto consider = [&](const Positions& candidate) {
      trial_ = candidate;
      if (contacts_inside()) put_on_planes(trial_);
      const double here = energy_.value(trial_);
      count_evaluations();
      if (here < lowest) {
        lowest = here;
        x.swap(trial_);
      }
    };
    x = state.x;
    consider(energy_.inertial());
    consider(state.x);
    ahead_ = state.x + h * state.v;
    // The time between states, not the last step's length: within BDF2 they differ.
    const double since = state.time - time_before_;
    if (since > 0) ahead_ += (h * h / since) * (state.v - v_before_);
    for (const int vertex : problem().pinned()) ahead_.col(vertex) = state.x.col(vertex);
    consider(ahead_);
    return lowest;
  }

  enum class Search { full, shortened, at_minimum, failed };

  // Finds a step along step_ that lowers the energy `current` enough; trial_ and `current` get it.
  Search search(const Positions& x, double longest, double& current) {
    const double slope = energy_.gradient().dot(step_);
    double scale = 1;
    for (int halvings = 0;; ++halvings) {
      trial_ = x;
      for (std::size_t f = 0; f < energy_.matrix().vertex.size(); ++f)
        trial_.col(energy_.matrix().vertex[f]) +=
            scale * step_.segment<3>(static_cast<Eigen::Index>(3 * f));
      const double next = energy_.value(trial_);
      count_evaluations();
      // Near the minimum the decrease drowns in rounding: a step below the tolerance is taken.
      if (next <= current + armijo_fraction * scale * slope || longest <= step_tolerance_) {
        current = next;
        return halvings == 0 ? Search::full : Search::shortened;
      }
      // The decrease that is left is below the energy's rounding error: this is the minimum.
      if (-slope <= rounding * current) return Search::at_minimum;
      if (halvings == halving_limit || !std::isfinite(slope)) return Search::failed;
      scale *= 0.5;
      ++work_.line_search_steps;
    }
  }

  // Puts vertices that went through planes, and those that are held, onto them; whether any moved.
  bool put_on_planes(Positions& x) {
    const Contacts::Timing measured = contacts_->timing();
    contacts_->find(x, work_);
    bool moved = false;
    for (int c = 0; c < contacts_->count(); ++c) {
      auto at = x.col(contacts_->vertex(c));
      const double gap = contacts_->gap(c, at);
      if (!contacts_->holds(c)) {
        if (gap >= -contacts_->tolerance()) continue;
        contacts_->set_push(c, held);
      }
      moved |= std::abs(gap) > contacts_->tolerance();
      at -= gap * contacts_->normal(c);
    }
    return moved;
  }

  // At the energy's minimum within the planes: whether one of them pulls, and so releases its
  // vertex. One that comes back stays for the rest of the step, so that this ends. The others push
  // by what moves a free mass as far.
  bool release_pulled() {
    const Contacts::Timing measured = contacts_->timing();
    bool released = false;
    for (int c = 0; c < contacts_->count(); ++c) {
      if (!contacts_->holds(c)) continue;
      const double push = energy_.reaction(c) / problem().mass()[contacts_->vertex(c)];
      if (push < 0 && released_[c] == Release::never) {
        contacts_->set_push(c, 0);
        released_[c] = Release::once;
        released = true;
      } else {
        contacts_->set_push(c, std::max(push, held));
      }
    }
    return released;
  }

  // Lowers the energy, `current` at x, to its minimum.
  StepResult newton(double current, Positions& x) {
    // Every step would seem to lower it.
    if (!std::isfinite(current)) return {Status::not_finite, 0, -1, 0, "the energy overflows"};
    if (energy_.matrix().vertex.empty()) return {};  // all are pinned: x is where they are

    bool reuse = false;
    double last_longest = 0;
    for (int j = 0;; ++j) {
      if (j == max_iterations_) return {Status::not_converged, j, -1, 0, "iteration limit"};
      energy_.assemble(x, contacts_inside(), !reuse);
      if (reuse) {
        count_evaluations();
      } else {
        ++work_.assemblies;
        if (!factor_counted(*energy_.matrix().solver, work_))
          return {std::isfinite(current) ? Status::singular : Status::not_finite, j, -1, 0,
                  "the Newton matrix is singular"};
      }
      step_ = -energy_.gradient();
      energy_.matrix().solver->solve(
          step_.data());  // Newton; Baraff and Witkin (1998) take its first step only
      ++work_.back_solves;
      const double longest =
          std::sqrt(Eigen::Map<const Positions>(step_.data(), 3, step_.size() / 3)
                        .colwise()
                        .squaredNorm()
                        .maxCoeff());
      const Search found = search(x, longest, current);
      if (found == Search::at_minimum) {
        if (!contacts_inside() || !release_pulled()) return {Status::ok, j + 1};
        reuse = false;
        continue;
      }
      if (found == Search::failed)
        return {Status::not_converged, j, -1, 0,
                "no step along Newton's direction lowers the energy"};
      energy_.predict_tension(x, trial_);
      count_evaluations();
      x.swap(trial_);
      if (contacts_inside() && put_on_planes(x)) {
        current = energy_.value(x);
        reuse = false;
        last_longest = longest;
        continue;
      }
      const bool fast = !reuse || longest <= fast_convergence * last_longest;
      const bool ended = found == Search::full && fast && longest <= step_tolerance_;
      const bool released = ended && contacts_inside() && release_pulled();
      if (ended && !released) return {Status::ok, j + 1};
      reuse = found == Search::full && fast && longest <= reuse_below_ && !released;
      last_longest = longest;
    }
  }

  // The history is of accepted steps, so that one tried again after a refusal starts as it did.
  StepResult end_velocities(const State& before, double h, const Positions& x,
                            Positions& v) override {
    v_before_ = before.v;
    time_before_ = before.time;
    energy_.accept();
    return Stepper::end_velocities(before, h, x, v);
  }

  SpringEnergy energy_;
  int max_iterations_;
  double step_tolerance_;  // m
  double reuse_below_;     // m
  Positions trial_;        // a line search's
  Positions ahead_;        // where history leads
  enum class Release : char { never, once };
  std::vector<Release> released_;  // of each contact, in this step; with contact inside only
  Eigen::VectorXd step_;
  Positions v_before_;                                            // v^{n-1}
  double time_before_ = std::numeric_limits<double>::infinity();  // s, of v_before_
};

}  // namespace

Backend implicit_springs_row() {
  return {
      .name = "implicit_springs",
      .summary = "stiff springs, by Newton with line search",
      .strain_control = StrainControl::stiffness,
      .settings = {{"stiffness", 1e4, "spring stiffness EA in N; sweeps search it", positive},
                   iteration_limit(300, "Newton iterations a step before it is refused"),
                   {"newton_tolerance", 0.1,
                    "last Newton step, in strain limit times shortest rest length", positive,
                    SearchRange{0.01, 10}},
                   // Instructions at 1 % strain and 1/100 s, plain Newton = 1, on the chain of 80
                   // and the drape of 21 x 21: 0.66 and 0.77 without reuse, 0.59 and 0.55 with 10.
                   // A reuse of 30 takes 0.55 and 0.53 but ends steps less exactly on the chain.
                   {"reuse", 10.0,
                    "a Newton step below this many tolerances keeps its factorization for the "
                    "next; 0: never",
                    Range{}, SearchRange{0, 100}}},
      .make = make_step<ImplicitSprings>,
      .direction = Direction::springs,
      .citation = "Baraff and Witkin 1998",
      .origin = Origin::paper,
      .label = "implicit springs",
      .backward_euler = true};
}

}  // namespace inextensible
