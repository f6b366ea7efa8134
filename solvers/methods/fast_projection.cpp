// Fast projection (Goldenthal et al. 2007, Algorithm 1): steps of least M-norm towards the
// constraint manifold, line by line. With mu = h^2 dlambda the step h drops out of equations 5 and
// 7:
//   (J W J^T) mu = C(x_j),   x_{j+1} = x_j - W J^T mu,   J = J(x_j).
// Loops: two passes over edges, one assembly, one factorization and one solve an iteration.
//
// Where J W J^T is singular or nearly so (a row pulled straight between two pins, Q3) that step
// does not exist or overshoots. When several iterations have not lowered |C|^2, or one has raised
// it by more than `overshoot`, the best x_j is restored, and the rest of the step is Levenberg's
// and Marquardt's (1963) with the damping rule of Nielsen (1999):
//   (J W J^T + damping D) mu = C~,   D the diagonal,
// which minimizes |C~ + J dx|^2 + damping |dx|^2 in the norms of D^-1 and M. C~ is what of C lies
// outside a fraction of the permissible band: `inner_band` for damped projections, `target` for the
// others (0: all of C).
//
// A factorization in single precision solves (7) to a residual of a fraction of |C(x_j)|, the
// forcing term of an inexact Newton method: first_forcing, then as |C| has fallen, squared
// (Eisenstat and Walker 1996, choice 2), which keeps the convergence of order two.
#include "solvers/methods/rows.h"
#include "solvers/methods/strain_passes.h"

namespace inextensible {
namespace {

// Iterations without a new least |C|: Newton often recovers from a rise or two, but not from a rise
// of |C|^2 by `overshoot`, where J W J^T is singular up to rounding and digits are lost.
constexpr int patience = 8;
constexpr double overshoot = 1e8, overshoot_in_contact = 100;
constexpr double least_forcing = 1e-8, damped_forcing = 1e-4;
// Target of damped projections: where J W J^T is singular, a straight row at full length has no
// neighbour with C = 0, but many permissible ones.
constexpr double inner_band = 0.6;
constexpr double first_damping = 1e-4, least_damping = 1e-9, largest_damping = 1e8;

class FastProjection final : public VelocityFilter {
 public:
  FastProjection(const Problem& problem, const BackendOptions& options, Along along)
      : system_(problem, options.strain_limit, options.word("linear_solver"),
                ConstraintSystem::Digits::few),
        along_(along),
        max_iterations_(options.count("max_iterations")),
        min_iterations_(options.count("min_iterations")),
        sweeps_before_(options.count("sweeps_before")),
        smoothing_sweeps_(options.count("smoothing_sweeps")),
        target_(options.number("target")),
        first_forcing_(options.number("first_forcing")),
        best_{Positions(3, problem.vertices()), {}},
        u_(3, problem.constraints()),
        u_start_(3, along == Along::middle ? problem.constraints() : 0),
        mu_(problem.constraints()),
        excess_(problem.constraints()) {
    if ((smoothing_sweeps_ > 0 || sweeps_before_ > 0) && !system_.chain())
      passes_ = std::make_unique<StrainPasses>(
          StrainPasses::by_mass(problem, {options.strain_limit, options.number("smoothing_target")},
                                options.number("smoothing_relaxation")));
  }

  StepResult apply(const Positions& x_start, double /*h*/, Iterate x, WorkCounters& work) override {
    const EdgeConstraints& edges = system_.edges();
    if (along_ == Along::middle) {
      edges.gradient(x_start, u_start_);
      if (passes_) passes_->take_middle_from(x_start);
    }
    double least_error = std::numeric_limits<double>::infinity();  // |C~|^2 at best_
    double last_error = least_error, forcing = first_forcing_;
    for (int j = 0, best_j = 0;; ++j) {
      if (observer_) show(j, x);
      bool permissible = linearize(target_, x);
      if (j == 0 && !permissible && sweeps_before_ > 0) {
        pass(sweeps_before_, x, work);
        permissible = linearize(target_, x);
      }
      if (permissible && j >= min_iterations_) return {Status::ok, j};
      if (j == max_iterations_)
        return refuse(Status::not_converged, j, edges, x, "iteration limit");

      const double error = mu_.squaredNorm();
      if (error == 0) return {Status::ok, j};  // nothing left to project
      if (error < least_error) {
        least_error = error;
        best_j = j;
        keep_best(x);
      } else if (j == 0) {
        return refuse(Status::not_finite, j, edges, x, "overflow");
      }
      if (j > 0) forcing = std::clamp(0.9 * error / last_error, least_forcing, first_forcing_);
      last_error = error;
      const double most = (x.contact_count() > 0 ? overshoot_in_contact : overshoot) * least_error;
      if (j - best_j == patience || !(error < most)) return damped(j, x, work);

      if (!system_.factor(u_, x.contacts(), work)) return damped(j, x, work);  // J W J^T
      if (!system_.solve(mu_, work, forcing)) return damped(j, x, work);       // (7)
      correct(x);                                                              // (5)
      pass(smoothing_sweeps_, x, work);
      x.renew_planes(work);
    }
  }

  const char* linear_solver() const override { return system_.solver_name().c_str(); }

 private:
  // C~(x) for this target to mu_, the gradient of C to u_; that of the middle of the step makes of
  // the iteration Newton's with J(m) W J(m)^T for J(x_j) W J(m)^T. Whether x is permissible.
  bool linearize(double target, const Positions& x) {
    const bool permissible = system_.edges().linearize(x, u_, mu_, target);
    if (along_ == Along::middle) to_middle(u_start_, u_);
    return permissible;
  }

  void correct(Iterate x) {
    system_.edges().apply(u_, mu_, x);  // (5)
    x.settle();
  }

  void keep_best(Iterate x) {
    x.save(best_);
    if (observer_) best_multipliers_ = multipliers_;
  }

  // At most this many passes of colored Gauss-Seidel.
  void pass(int most, Iterate x, WorkCounters& work) {
    if (!passes_ || most == 0) return;
    passes_->load(x);
    passes_->in_turn(most, work);
    passes_->settle_contacts();
    passes_->store(x);
  }

  // Before mu_, the step to x_j, is overwritten. Passes move vertices without multipliers.
  void show(int j, const Positions& x) {
    if (passes_) return;
    if (j == 0) {
      multipliers_.setZero(mu_.size());
    } else {
      multipliers_ += mu_;
    }
    observer_->iterate(system_.edges(), j, x, multipliers_);
  }

  // From best_ on; j iterations are done.
  StepResult damped(int j, Iterate x, WorkCounters& work) {
    const EdgeConstraints& edges = system_.edges();
    double damping = first_damping, growth = 2;
    double error = 0;
    for (bool taken_back = true;; ++j) {
      if (taken_back) {
        ++work.line_search_steps;
        x.restore(best_);
        if (observer_) multipliers_ = best_multipliers_;
        linearize(inner_band, x);
        error = mu_.squaredNorm();
      }
      if (j >= max_iterations_)
        return refuse(Status::not_converged, j, edges, x, "iteration limit");
      excess_ = mu_;
      while (damping < largest_damping && !(system_.factor(u_, x.contacts(), work, damping) &&
                                            system_.solve(mu_, work, damped_forcing))) {
        damping *= 10;
        mu_ = excess_;
      }
      if (!(damping < largest_damping))
        return refuse(Status::not_converged, j, edges, x,
                      "no damped projection lowers the constraint error");
      const double predicted_error = damped_prediction(damping);
      correct(x);
      if (observer_) show(j + 1, x);
      if (linearize(inner_band, x)) return {Status::ok, j + 1};
      const double next_error = mu_.squaredNorm();
      taken_back = !(next_error < error);
      if (taken_back) {
        damping *= growth;
        growth *= 2;
      } else {
        const double gain = (error - next_error) / (error - predicted_error);
        damping *= std::max(1.0 / 3, 1 - std::pow(2 * gain - 1, 3));
        damping = std::max(damping, least_damping);
        growth = 2;
        error = next_error;
        keep_best(x);
      }
    }
  }

  // |C~ + J dx|^2 = |damping D mu|^2: what the linear model leaves of the error.
  double damped_prediction(double damping) const {
    const EdgeConstraints& edges = system_.edges();
    double sum = 0;
    for (int k = 0; k < edges.count(); ++k) {
      const double d = (edges.wa[k] + edges.wb[k]) * u_.col(k).squaredNorm();
      sum += std::pow(damping * d * mu_[k], 2);
    }
    return sum;
  }

  ConstraintSystem system_;
  Along along_;
  int max_iterations_, min_iterations_, sweeps_before_, smoothing_sweeps_;
  double target_, first_forcing_;
  std::unique_ptr<StrainPasses> passes_;  // if any are asked for
  Iterate::Record best_;                  // x_j of least constraint error
  Eigen::Matrix3Xd u_;                    // gradient of C at x_j, or in the middle of the step
  Eigen::Matrix3Xd u_start_;              // at x^n, for the middle of the step only
  Eigen::VectorXd mu_;                    // C~(x_j), then h^2 dlambda
  Eigen::VectorXd excess_;                // C~ of a damped iteration
  // With an observer only: h^2 lambda at x_j and at best_.
  Eigen::VectorXd multipliers_, best_multipliers_;
};

}  // namespace

Backend fast_projection_row() {
  constexpr bool departs = true;  // Algorithm 1 has no passes
  return {.name = "fast_projection",
          .summary =
              "the paper's Algorithm 1: repeated projections, constraint directions from the "
              "current iterate",
          .settings = {iteration_limit(200, "projections a step before it is refused"),
                       least_iterations(),
                       projection_target(),
                       // A projection sees the whole cloth, but only to first order; most of what
                       // it leaves is local, and cheaper to correct by passes over edges.
                       {"sweeps_before", 0.0,
                        "colored Gauss-Seidel passes before the first projection, at most; none on "
                        "chains, where a projection costs no more than some passes",
                        count_from_zero, tunable_passes, departs},
                       {"smoothing_sweeps", 0.0,
                        "the same after each projection, at most; none on chains", count_from_zero,
                        tunable_passes, departs},
                       {"smoothing_target", 0.5, pass_target, fraction, tunable_fraction, departs},
                       {"smoothing_relaxation", 1.4, "times a pass's correction", relaxation_range,
                        tunable_relaxation, departs},
                       {"first_forcing", 1e-2,
                        "residual of a step's first linear solve in mixed precision, of the  "
                        "right-hand side; those of later ones are smaller",
                        Range{1e-8, 1}, tunable_forcing},
                       schur_solver()},
          .make_filter = make_filter<FastProjection>,
          .takes_middle = true,
          .direction = Direction::current,
          .citation = "Goldenthal et al. 2007",
          .origin = Origin::paper,
          .label = "fast projection",
          .shows_iterates = true};
}

}  // namespace inextensible
