// Averaging: edge k's correction is divided by the mean valence of its ends, weighted by their
// inverse masses,
//   omega_k = (w_a + w_b) / (w_a deg_a + w_b deg_b),
// the same factor at both ends, so momentum is kept (dividing by each vertex's own valence would
// not). Linearized, the sweep is x -= W J^T S J x with every row of S J W J^T summing in absolute
// value to at most 1, hence all its eigenvalues lie in [0, 1]: it converges at any valence and any
// masses, and up to relaxation 2. The default, 1.8, takes about a third fewer sweeps than the plain
// average on the drape. Loops: one pass over edges, one over vertices, one check that stops at the
// first violation.
#include "jacobi.h"

#include <cmath>

namespace inextensible {

Jacobi::Jacobi(const Problem& problem, const Settings& settings)
    : edges_(problem, settings.strain_limit),
      max_iterations_(settings.max_iterations),
      target_low_(1 - settings.target * settings.strain_limit),
      target_high_(1 + settings.target * settings.strain_limit),
      share_a_(static_cast<std::size_t>(problem.constraints())),
      share_b_(share_a_.size()),
      correction_(3, problem.vertices()) {
  std::vector<int> valence(static_cast<std::size_t>(problem.vertices()), 0);
  for (std::size_t k = 0; k < share_a_.size(); ++k) {
    ++valence[static_cast<std::size_t>(edges_.a[k])];
    ++valence[static_cast<std::size_t>(edges_.b[k])];
  }
  for (std::size_t k = 0; k < share_a_.size(); ++k) {
    const double weighted = edges_.wa[k] * valence[static_cast<std::size_t>(edges_.a[k])] +
                            edges_.wb[k] * valence[static_cast<std::size_t>(edges_.b[k])];
    share_a_[k] = settings.relaxation * edges_.wa[k] / weighted;
    share_b_[k] = settings.relaxation * edges_.wb[k] / weighted;
  }
}

std::int64_t Jacobi::sweep(Positions& x) {
  correction_.setZero();
  const double* p = x.data();
  double* c = correction_.data();
  std::int64_t projections = 0;
  for (std::size_t k = 0; k < share_a_.size(); ++k) {
    const double* pa = p + 3 * edges_.a[k];
    const double* pb = p + 3 * edges_.b[k];
    const double d0 = pb[0] - pa[0], d1 = pb[1] - pa[1], d2 = pb[2] - pa[2];
    const double il = edges_.inverse_rest_length[k];
    const double q = (d0 * d0 + d1 * d1 + d2 * d2) * il * il;
    if ((q >= edges_.permissible_low && q <= edges_.permissible_high) || q == 0) continue;
    const double wanted = q < edges_.permissible_low ? target_low_ : target_high_;
    const double excess = 1 - wanted / std::sqrt(q);
    const double sa = share_a_[k] * excess, sb = share_b_[k] * excess;
    double* ca = c + 3 * edges_.a[k];
    double* cb = c + 3 * edges_.b[k];
    ca[0] += sa * d0;
    ca[1] += sa * d1;
    ca[2] += sa * d2;
    cb[0] -= sb * d0;
    cb[1] -= sb * d1;
    cb[2] -= sb * d2;
    ++projections;
  }
  x += correction_;
  return projections;
}

StepResult Jacobi::apply(const Positions& /*x_start*/, double /*h*/, Positions& x,
                         WorkCounters& work) {
  for (int sweeps = 0;; ++sweeps) {
    if (edges_.permissible(x)) return {Status::ok, sweeps};
    if (sweeps == max_iterations_ || (sweeps % 64 == 63 && !x.allFinite())) {
      return refuse(Status::not_converged, sweeps, edges_, x, "sweep limit");
    }
    const std::int64_t projections = sweep(x);
    work.edge_projections += projections;
    if (projections == 0)
      return refuse(Status::not_converged, sweeps, edges_, x, "an edge has no length");
  }
}

}  // namespace inextensible
