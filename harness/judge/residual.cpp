#include "harness/judge/residual.h"

namespace harness {

void ResidualProbe::watch() {
  watching_ = true;
  iterations_ = 0;
}

void ResidualProbe::iterate(const inextensible::EdgeConstraints& edges, int j,
                            const inextensible::Positions& x, const Eigen::VectorXd& multipliers) {
  if (!watching_) return;
  edges_ = &edges;
  iterations_ = j;
  if (j == 0) {
    x0_ = x;
    return;
  }
  // Kept only: the solver's clock runs.
  Iterate& kept = j == 1 ? first_ : last_;
  kept.x = x;
  kept.multipliers = multipliers;
}

double ResidualProbe::mean_residual(const Iterate& at) const {
  Eigen::Matrix3Xd u(3, at.multipliers.size());
  edges_->gradient(at.x, u);
  inextensible::Positions f = at.x - x0_;
  edges_->apply(u, -at.multipliers, f);
  return f.colwise().norm().mean();
}

std::optional<ResidualProbe::Residuals> ResidualProbe::residuals() {
  watching_ = false;
  if (iterations_ == 0) return {};
  const double first = mean_residual(first_);
  return Residuals{first, iterations_ == 1 ? first : mean_residual(last_), iterations_};
}

}  // namespace harness
