// A step of the implicit springs: where Newton starts, its iterations, and their line search.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/methods/implicit_springs.h"
#include "solvers/problem/forces.h"

namespace inextensible {
namespace {

constexpr double held = 1e-300;  // m: a push that says no more than that
constexpr int halving_limit = 30;
constexpr double armijo_fraction = 1e-4;
constexpr double rounding = 1e-14;
// What a step with an old factorization must shrink to, times the last. The error it leaves is then
// no more than the step itself.
constexpr double fast_convergence = 0.5;

}  // namespace

// Where Newton starts, to x; returns its energy. Whatever the history is, the start is never higher
// than the free flight and the start of the step.
double ImplicitSprings::start(const State& state, double h, Positions& x) {
  double lowest = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Positions& candidate) {
    trial_ = candidate;
    if (contacts_inside()) put_on_planes(trial_);
    const double here = energy(trial_, h);
    work_.spring_evaluations += static_cast<std::int64_t>(hessian_.springs.size());
    if (here < lowest) {
      lowest = here;
      x.swap(trial_);
    }
  };
  x = state.x;
  consider(inertial_);
  consider(state.x);
  ahead_ = state.x + h * state.v;
  // The time between states, not the last step's length: within BDF2 they differ.
  const double since = state.time - time_before_;
  if (since > 0) ahead_ += (h * h / since) * (state.v - v_before_);
  for (const int vertex : problem().pinned()) ahead_.col(vertex) = state.x.col(vertex);
  consider(ahead_);
  return lowest;
}

// What the springs, linear at x, pull with at `to`, over their vectors there.
void ImplicitSprings::predict_tension(const Positions& x, const Positions& to) {
  for (std::size_t k = 0; k < hessian_.springs.size(); ++k) {
    const Spring& s = hessian_.springs[k];
    const Eigen::Vector3d from = x.col(s.b) - x.col(s.a), ahead = to.col(s.b) - to.col(s.a);
    const double length = from.norm(), length_ahead = ahead.norm();
    const double elongation = (length > 0 ? from.dot(ahead) / length : length_ahead) - s.rest;
    pull_[k] = length_ahead > 0 ? s.k * elongation / length_ahead : 0;
  }
  work_.spring_evaluations += static_cast<std::int64_t>(hessian_.springs.size());
}

// The step along step_ that lowers the energy `current` enough, to trial_, its energy to current.
ImplicitSprings::Search ImplicitSprings::search(const Positions& x, double h, double longest,
                                                double& current) {
  const double slope = gradient_.dot(step_);
  double scale = 1;
  for (int halvings = 0;; ++halvings) {
    trial_ = x;
    for (std::size_t f = 0; f < hessian_.matrix.vertex.size(); ++f) {
      trial_.col(hessian_.matrix.vertex[f]) +=
          scale * step_.segment<3>(static_cast<Eigen::Index>(3 * f));
    }
    const double next = energy(trial_, h);
    work_.spring_evaluations += static_cast<std::int64_t>(hessian_.springs.size());
    // Near the minimum the decrease drowns in rounding: a step below the tolerance is then taken
    // as it is.
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

StepResult ImplicitSprings::solve(const State& state, double h, Positions& x) {
  Stopwatch stopwatch(phases_wanted_);
  if (problem().has_drag()) before_ = state.x;
  free_flight(problem(), state, h, h * h, inertial_);
  pull_ = pull_before_;
  if (contacts_inside()) {
    contacts_->apply_friction(inertial_, work_);
    contacts_->find(inertial_, work_);
    std::fill(released_.begin(), released_.end(), Release::never);
    for (int c = 0; c < contacts_->count(); ++c) contacts_->set_push(c, held);
  }
  const double lowest = start(state, h, x);
  const StepResult result = newton(h, lowest, x);
  phases_.unconstrained += stopwatch();
  return result;
}

// Vertices that went through planes, and those that are held: onto them. Whether that moved any.
bool ImplicitSprings::put_on_planes(Positions& x) {
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

// At the energy's minimum within the planes: whether one of them pulls, and so releases its vertex.
// One that comes back stays for the rest of the step, so that this ends. The others push by what
// moves a free mass as far.
bool ImplicitSprings::release_pulled() {
  const Contacts::Timing measured = contacts_->timing();
  bool released = false;
  for (int c = 0; c < contacts_->count(); ++c) {
    if (!contacts_->holds(c)) continue;
    const double push = reaction_[c] / problem().mass()[contacts_->vertex(c)];
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
StepResult ImplicitSprings::newton(double h, double current, Positions& x) {
  // Every step would seem to lower it.
  if (!std::isfinite(current)) return {Status::not_finite, 0, -1, 0, "the energy overflows"};
  if (hessian_.matrix.vertex.empty()) return {};  // all are pinned: x is where they are

  bool reuse = false;
  double last_longest = 0;
  for (int j = 0;; ++j) {
    if (j == max_iterations_) return {Status::not_converged, j, -1, 0, "iteration limit"};
    assemble(x, h, !reuse);
    if (reuse) {
      work_.spring_evaluations += static_cast<std::int64_t>(hessian_.springs.size());
    } else {
      ++work_.assemblies;
      if (!factor_counted(*hessian_.matrix.solver, work_)) {
        return {std::isfinite(current) ? Status::singular : Status::not_finite, j, -1, 0,
                "the Newton matrix is singular"};
      }
    }
    step_ = -gradient_;
    hessian_.matrix.solver->solve(
        step_.data());  // Newton; Baraff and Witkin (1998) take its first step only
    ++work_.back_solves;
    const double longest = std::sqrt(Eigen::Map<const Positions>(step_.data(), 3, step_.size() / 3)
                                         .colwise()
                                         .squaredNorm()
                                         .maxCoeff());
    const Search found = search(x, h, longest, current);
    if (found == Search::at_minimum) {
      if (!contacts_inside() || !release_pulled()) return {Status::ok, j + 1};
      reuse = false;
      continue;
    }
    if (found == Search::failed) {
      return {Status::not_converged, j, -1, 0,
              "no step along Newton's direction lowers the energy"};
    }
    predict_tension(x, trial_);
    x.swap(trial_);
    if (contacts_inside() && put_on_planes(x)) {
      current = energy(x, h);
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
StepResult ImplicitSprings::end_velocities(const State& before, double h, const Positions& x,
                                           Positions& v) {
  v_before_ = before.v;
  time_before_ = before.time;
  pull_before_.swap(pull_);
  return Stepper::end_velocities(before, h, x, v);
}

}  // namespace inextensible
