// (5) and (7) are those of Goldenthal et al. 2007, which take J at x_j where SHAKE takes J(x^n).
//
// Newton on C(x0 - W J(x^n)^T h^2 lambda) = 0, with mu = h^2 dlambda. Its matrix J(x_j) W J(x^n)^T
// is replaced by J(x^n) W J(x^n)^T, symmetric and factored once a step; where that does not halve
// the constraint error, the true matrix at the best iterate so far is built, unsymmetric, and kept
// until it fails in turn. A step along its direction that does not lower the error is halved.
// The equations have spurious solutions far away; the closest point of the manifold is at most
// twice as far from x^n (on it) as x0 is, so what is farther, allowing for slack, is refused.
// Loops: one assembly and factorization a step, one solve and two passes over edges an iteration.
#include "solvers/methods/shake.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "solvers/methods/rows.h"

namespace inextensible {
namespace {

constexpr double shortest_step = 1e-3;  // of Newton's
constexpr const char* no_solution =
    "the linear solver did not converge, or its multipliers grew too large";

}  // namespace

Shake::Shake(const Problem& problem, const Settings& settings)
    : system_(problem, settings.strain_limit, settings.linear_solver),
      problem_(problem),
      slack_(settings.strain_limit * problem.longest_rest_length() *
             std::sqrt(problem.total_mass())),
      max_iterations_(settings.max_iterations),
      min_iterations_(settings.min_iterations),
      target_(settings.target),
      forcing_(settings.forcing),
      u_start_(3, problem.constraints()),
      u_(3, problem.constraints()),
      c_(problem.constraints()),
      mu_(problem.constraints()),
      best_{Positions(3, problem.vertices()), {}} {}

StepResult Shake::apply(const Positions& x_start, double /*h*/, Iterate x, WorkCounters& work) {
  const EdgeConstraints& edges = system_.edges();
  Matrix matrix = Matrix::start;
  double least_error = 0;  // |C| at best_
  double full_step = 0;    // |mu_| before halving
  double reach = 0;        // largest |x^{n+1} - x^n| that is not taken for spurious
  for (int j = 0;; ++j) {
    const bool permissible = linearize(x);
    const double error = c_.norm();
    const bool exact = error == 0 && (target_ > 0 || j > 0);  // nothing is left to project
    if (permissible && (j >= min_iterations_ || exact)) {
      if (j > 0 && distance(x_start, x) > reach)
        return refuse(Status::not_converged, j, edges, x, "a spurious solution, far from x^n");
      return {Status::ok, j};
    }
    if (j == max_iterations_) return refuse(Status::not_converged, j, edges, x, "iteration limit");

    if (j == 0) {
      reach = edges.permissible(x_start) ? 2 * distance(x_start, x) + slack_
                                         : std::numeric_limits<double>::infinity();
      if (!factor_start(x_start, x.contacts(), work)) {
        return refuse(Status::singular, j, edges, x,
                      "J W J^T at the start of the step is not positive definite");
      }
    } else if (error < 0.5 * least_error) {
      if (matrix == Matrix::here) matrix = Matrix::kept;
    } else if (matrix == Matrix::here && !(error < least_error)) {  // no decrease: half the step
      if (mu_.norm() < shortest_step * full_step) {
        return refuse(Status::not_converged, j, edges, x,
                      "no step along J(x^n) lowers the constraint error");
      }
      ++work.line_search_steps;
      mu_ *= 0.5;
      x.restore(best_);
      correct(x);
      continue;
    } else {
      if (!(error < least_error)) {
        x.restore(best_);
        linearize(x);
      }
      if (!factor_here(x.contacts(), work))
        return refuse(Status::singular, j, edges, x, "J(x_j) W J(x^n)^T is singular");
      matrix = Matrix::here;
    }
    least_error = c_.norm();
    x.save(best_);
    if (!solve(matrix, work)) return refuse(Status::singular, j, edges, x, no_solution);  // (7)
    full_step = mu_.norm();
    correct(x);  // (5)
  }
}

// The gradient to u_; what of C lies beyond the target to c_. Returns whether x is permissible.
bool Shake::linearize(const Positions& x) {
  const bool permissible = system_.edges().linearize(x, u_, c_);
  if (target_ > 0) system_.edges().excess(target_, c_);
  return permissible;
}

bool Shake::solve(Matrix matrix, WorkCounters& work) {
  mu_ = c_;
  if (matrix == Matrix::start)
    return system_.solve(mu_, work, forcing_);  // (7) with J(x^n) on both sides
  current_solver_->solve(mu_.data());           // (7) with J(x_j) W J(x^n)^T
  ++work.back_solves;
  return true;
}

void Shake::correct(Iterate x) {
  system_.edges().apply(u_start_, mu_, x);  // (5) with J(x^n)
  x.settle();
}

bool Shake::factor_start(const Positions& x_start, const Contacts* contacts, WorkCounters& work) {
  if (factored_ && x_factored_ == x_start) return true;
  factored_ = false;
  system_.edges().gradient(x_start, u_start_);
  return system_.factor(u_start_, contacts, work);
}

StepResult Shake::project_velocity(const Positions& x, const Contacts* contacts, Positions& v,
                                   WorkCounters& work) {
  const EdgeConstraints& edges = system_.edges();
  if (!factor_start(x, contacts, work)) {
    return refuse(Status::singular, 0, edges, x,
                  "J W J^T at the end of the step is not positive definite");
  }
  x_factored_ = x;
  factored_ = !contacts;         // which will be others in the next step
  edges.rate(u_start_, v, mu_);  // J v
  if (!system_.solve(mu_, work)) return refuse(Status::singular, 0, edges, x, no_solution);
  edges.apply(u_start_, mu_, v);
  if (contacts) contacts->keep_on_planes(x, v);
  return {};
}

double Shake::distance(const Positions& x_start, const Positions& x) const {
  double sum = 0;
  for (Eigen::Index v = 0; v < x.cols(); ++v)
    sum += problem_.mass()[v] * (x.col(v) - x_start.col(v)).squaredNorm();
  return std::sqrt(sum);
}

bool Shake::factor_here(const Contacts* contacts, WorkCounters& work) {
  if (!current_) {
    current_ = std::make_unique<UnsymmetricSchurComplement>(system_.edges(), problem_.vertices());
    current_solver_ = make_unsymmetric_solver(current_->column_start, current_->row_index);
  }
  current_->assemble(u_, u_start_, current_solver_->values());
  if (contacts) {
    if (!current_contact_terms_) {
      current_contact_terms_ = std::make_unique<ContactTerms>(
          system_.edges(), problem_.vertices(), current_->column_start, current_->row_index);
    }
    current_contact_terms_->subtract(*contacts, problem_.inverse_mass().data(), u_, u_start_,
                                     current_solver_->values());
  }
  ++work.assemblies;
  ++work.factorizations;
  return current_solver_->factor();
}

SettingFields<Shake::Settings> Shake::fields() {
  using S = Settings;
  return {{"max_iterations", &S::max_iterations, "iterations a step before it is refused",
           at_least_one},
          {"min_iterations", &S::min_iterations, least_iterations, count_from_zero,
           tunable_least_iterations},
          {"target", &S::target, projection_target, below_limit, tunable_below_limit},
          {"forcing", &S::forcing,
           "residual of linear solves by conjugate gradients, of the right-hand side",
           forcing_range, tunable_forcing},
          schur_solver_field<S>()};
}

Backend shake_row() {
  return {.name = "shake",
          .summary = "Lagrange multipliers, constraint directions from the start of the step",
          .strain_control = StrainControl::strain_limit,
          .contestant = true,
          .settings = setting_infos(Shake::fields()),
          .make_filter = make_filter<Shake>,
          .direction = Direction::start,
          .citation = "Ryckaert, Ciccotti and Berendsen 1977; Barth et al. 1994",
          .origin = Origin::paper,
          .label = "SHAKE",
          .stepper = "verlet"};
}

}  // namespace inextensible
