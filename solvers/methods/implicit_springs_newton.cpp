// A step of the implicit springs: where Newton starts, its iterations, and their line search.
#include <algorithm>
#include <cmath>

#include "inextensible/methods/implicit_springs.h"

namespace inextensible {
namespace {

constexpr int halving_limit = 30;
constexpr double armijo_fraction = 1e-4;
constexpr double rounding = 1e-14;
// Rounds in which friction follows pressures, and the change of pressures that ends them.
constexpr int most_rounds = 10;
constexpr double pressure_tolerance = 0.1;
// What a step with an old factorization must shrink to, times the last. The error it leaves is then
// no more than the step itself.
constexpr double fast_convergence = 0.5;

}  // namespace

// Where Newton starts, to x; returns its energy. Whatever the history is, the start is never higher
// than the free flight and the start of the step.
double ImplicitSprings::start(const State& state, double h, Positions& x) {
  const auto count = static_cast<std::int64_t>(springs_.size());
  const double flight = energy(inertial_, h), rest = energy(state.x, h);
  work_.spring_evaluations += 2 * count;
  double lowest = std::min(flight, rest);
  x = flight <= rest ? inertial_ : state.x;
  if (!extrapolates_) return lowest;
  trial_ = state.x + h * state.v;
  if (h_before_ > 0) trial_ += (h * h / h_before_) * (state.v - v_before_);
  for (const int vertex : problem().pinned()) trial_.col(vertex) = state.x.col(vertex);
  const double ahead = energy(trial_, h);
  work_.spring_evaluations += count;
  if (ahead < lowest) {
    lowest = ahead;
    x.swap(trial_);
  }
  return lowest;
}

// What the springs, linear at x, pull with at `to`, over their vectors there.
void ImplicitSprings::predict_tension(const Positions& x, const Positions& to) {
  for (std::size_t k = 0; k < springs_.size(); ++k) {
    const Spring& s = springs_[k];
    const Eigen::Vector3d from = x.col(s.b) - x.col(s.a), ahead = to.col(s.b) - to.col(s.a);
    const double length = from.norm(), length_ahead = ahead.norm();
    const double elongation = (length > 0 ? from.dot(ahead) / length : length_ahead) - s.rest;
    pull_[k] = length_ahead > 0 ? s.k * elongation / length_ahead : 0;
  }
  work_.spring_evaluations += static_cast<std::int64_t>(springs_.size());
}

// The step along step_ that lowers the energy `current` enough, to trial_, its energy to current.
ImplicitSprings::Search ImplicitSprings::search(const Positions& x, double h, double longest,
                                                double& current) {
  const double slope = gradient_.dot(step_);
  double scale = 1;
  for (int halvings = 0;; ++halvings) {
    trial_ = x;
    for (std::size_t f = 0; f < free_vertex_.size(); ++f) {
      trial_.col(free_vertex_[f]) += scale * step_.segment<3>(static_cast<Eigen::Index>(3 * f));
    }
    const double next = energy(trial_, h);
    work_.spring_evaluations += static_cast<std::int64_t>(springs_.size());
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
  if (problem().has_drag()) before_ = state.x;
  const Eigen::Vector3d fall = h * h * problem().gravity();
  inertial_ = state.x + h * state.v;
  inertial_.colwise() += fall;
  for (const int vertex : problem().pinned()) inertial_.col(vertex) = state.x.col(vertex);
  pull_ = pull_before_;
  if (!contact_energy_) return newton(h, start(state, h, x), x);
  contacts_->find(inertial_, work_);
  contact_energy_->expect_pressures(problem().mass(), h, inertial_);
  for (int round = 0, iterations = 0;; ++round) {
    StepResult result = newton(h, round == 0 ? start(state, h, x) : energy(x, h), x);
    result.iterations = iterations += result.iterations;
    if (!result || round == most_rounds) return result;
    if (contact_energy_->take_pressures(x) <= pressure_tolerance) return result;
  }
}

bool ImplicitSprings::finds_contacts(const Positions& x) {
  if (!contact_energy_) return false;
  const int known = contacts_->count();
  contacts_->find(x, work_);
  return contacts_->count() > known;
}

// Lowers the energy, `current` at x, to its minimum.
StepResult ImplicitSprings::newton(double h, double current, Positions& x) {
  // Every step would seem to lower it.
  if (!std::isfinite(current)) return {Status::not_finite, 0, -1, 0, "the energy overflows"};
  if (free_vertex_.empty()) return {};  // all are pinned: x is where they are

  bool reuse = false;
  double last_longest = 0;
  for (int j = 0;; ++j) {
    if (j == max_iterations_) return {Status::not_converged, j, -1, 0, "iteration limit"};
    assemble(x, h, !reuse);
    if (reuse) {
      work_.spring_evaluations += static_cast<std::int64_t>(springs_.size());
    } else {
      ++work_.assemblies;
      ++work_.factorizations;
      if (!solver_->factor()) {
        return {std::isfinite(current) ? Status::singular : Status::not_finite, j, -1, 0,
                "the Newton matrix is singular"};
      }
      work_.factor_nonzeros = solver_->factor_nonzeros();
      work_.factor_flops = solver_->factor_flops();
    }
    step_ = -gradient_;
    solver_->solve(step_.data());  // Newton; Baraff and Witkin (1998) take its first step only
    ++work_.back_solves;
    const double longest = std::sqrt(Eigen::Map<const Positions>(step_.data(), 3, step_.size() / 3)
                                         .colwise()
                                         .squaredNorm()
                                         .maxCoeff());
    const Search found = search(x, h, longest, current);
    if (found == Search::at_minimum) return {Status::ok, j + 1};
    if (found == Search::failed) {
      return {Status::not_converged, j, -1, 0,
              "no step along Newton's direction lowers the energy"};
    }
    if (predicts_tension_) predict_tension(x, trial_);
    x.swap(trial_);
    if (finds_contacts(x)) {  // which are in the energy from now on
      current = energy(x, h);
      reuse = false;
      last_longest = longest;
      continue;
    }
    const bool fast = !reuse || longest <= fast_convergence * last_longest;
    if (found == Search::full && fast && longest <= step_tolerance_) return {Status::ok, j + 1};
    reuse = found == Search::full && fast && longest <= reuse_below_;
    last_longest = longest;
  }
}

// The history is of accepted steps, so that one tried again after a refusal starts as it did.
StepResult ImplicitSprings::end_velocities(const State& before, double h, const Positions& filtered,
                                           const Positions& x, Positions& v) {
  v_before_ = before.v;
  h_before_ = h;
  pull_before_.swap(pull_);
  if (contact_energy_) contact_energy_->accept();
  return Stepper::end_velocities(before, h, filtered, x, v);
}

}  // namespace inextensible
