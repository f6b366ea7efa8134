// Within a color no edge sees another's correction, so that a sweep equals one that visits edges
// one after the other, color after color. The order is the same in every sweep; the random one of
// gauss_seidel takes about a third more sweeps. What colors win on one processor is vectors, see
// strain_sweep.cpp.
//
// A sweep that corrects nothing has seen every edge in its final place: it is the test of
// convergence, and is not counted. Loops: one pass over edges a sweep.
#include "inextensible/methods/gauss_seidel_colored.h"

namespace inextensible {
GaussSeidelColored::GaussSeidelColored(const Problem& problem, const Settings& settings)
    : edges_(problem, settings.strain_limit),
      max_iterations_(settings.max_iterations),
      sweep_(StrainSweep::by_mass(problem, {settings.strain_limit, settings.target},
                                  settings.relaxation)) {}

StepResult GaussSeidelColored::apply(const Positions& /*x_start*/, double /*h*/, Positions& x,
                                     WorkCounters& work) {
  return sweep_.limit(StrainSweep::Order::in_turn, max_iterations_, edges_, x, work);
}

}  // namespace inextensible
