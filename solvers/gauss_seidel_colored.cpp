// Within a color no edge sees another's correction, so that a sweep equals one that visits edges
// one after the other, color after color. The order is the same in every sweep; the random one of
// gauss_seidel takes about a third more sweeps. What colors win on one processor is vectors, see
// strain_sweep.cpp.
//
// A sweep that corrects nothing has seen every edge in its final place: it is the test of
// convergence, and is not counted. Loops: one pass over edges a sweep.
#include "gauss_seidel_colored.h"

namespace inextensible {
GaussSeidelColored::GaussSeidelColored(const Problem& problem, const Settings& settings)
    : edges_(problem, settings.strain_limit),
      max_iterations_(settings.max_iterations),
      sweep_(StrainSweep::by_mass(problem, {settings.strain_limit, settings.target},
                                  settings.relaxation)) {}

StepResult GaussSeidelColored::apply(const Positions& /*x_start*/, double /*h*/, Positions& x,
                                     WorkCounters& work) {
  sweep_.load(x);
  for (int sweeps = 0;; ++sweeps) {
    const bool gives_up = sweeps == max_iterations_ || (sweeps % 64 == 63 && !sweep_.finite());
    const std::int64_t projections = gives_up ? 0 : sweep_.in_turn();
    work.edge_projections += projections;
    if (projections > 0) continue;
    sweep_.store(x);
    if (edges_.permissible(x)) return {Status::ok, sweeps};
    return refuse(Status::not_converged, sweeps, edges_, x,
                  gives_up ? "sweep limit" : "an edge has no length");
  }
}

}  // namespace inextensible
