#include "harness/judge/residual.h"

#include "inextensible/problem/forces.h"

namespace harness {
namespace {

constexpr int iteration_limit = 50;

}  // namespace

ResidualProbe::ResidualProbe(std::shared_ptr<const inextensible::Problem> problem,
                             double strain_limit)
    : problem_(std::move(problem)),
      system_(*problem_, strain_limit, "auto"),
      x0_(3, problem_->vertices()),
      u_(3, problem_->constraints()),
      mu_(problem_->constraints()),
      sum_(problem_->constraints()) {}

double ResidualProbe::mean_residual(const inextensible::Positions& x) {
  f_ = x - x0_;
  system_.edges().apply(u_, -sum_, f_);  // u_ is the gradient at x
  return f_.colwise().norm().mean();
}

std::optional<ResidualProbe::Residuals> ResidualProbe::of_step(const inextensible::State& start,
                                                               double h) {
  unconstrained_step(*problem_, start, h, x0_, work_);
  x_ = x0_;
  sum_.setZero();
  Residuals residuals;
  for (int j = 0;; ++j) {
    const bool permissible = system_.edges().linearize(x_, u_, mu_);
    if (j > 0 && (j == 1 || permissible)) {
      residuals.last = mean_residual(x_);
      if (j == 1) residuals.first = residuals.last;
    }
    residuals.iterations = j;
    if (permissible) break;
    if (j == iteration_limit || !system_.factor(u_, work_)) return {};
    system_.solve(mu_, work_);
    sum_ += mu_;
    system_.edges().apply(u_, mu_, x_);
  }
  if (residuals.iterations == 0) return {};
  return residuals;
}

}  // namespace harness
