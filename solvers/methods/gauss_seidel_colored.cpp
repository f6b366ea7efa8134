// Within a color no edge sees another's correction, so that a pass equals one that visits edges
// one after the other, color after color. The order is the same in every pass; the random one of
// gauss_seidel takes about a third more passes. What colors win on one processor is vectors, see
// strain_passes.cpp.
//
// A pass that corrects nothing has seen every edge in its final place: it is the test of
// convergence, and is not counted. Loops: one pass over edges.
#include "solvers/methods/gauss_seidel_colored.h"

namespace inextensible {

GaussSeidelColored::GaussSeidelColored(const Problem& problem, const Settings& settings,
                                       Along along)
    : edges_(problem, settings.strain_limit),
      max_iterations_(settings.max_iterations),
      along_(along),
      passes_(StrainPasses::by_mass(problem, {settings.strain_limit, settings.target},
                                    settings.relaxation)) {}

StepResult GaussSeidelColored::apply(const Positions& x_start, double /*h*/, Iterate x,
                                     WorkCounters& work) {
  if (along_ == Along::middle) passes_.take_middle_from(x_start);
  return passes_.limit(StrainPasses::Order::in_turn, max_iterations_, edges_, x, work);
}

SettingFields<GaussSeidelColored::Settings> GaussSeidelColored::fields() {
  using S = Settings;
  return {
      {"max_iterations", &S::max_iterations, "passes a step before it is refused", at_least_one},
      {"target", &S::target, "a corrected edge is brought to this fraction of the strain limit",
       fraction, tunable_fraction},
      {"relaxation", &S::relaxation, "times the correction", relaxation_range, tunable_relaxation}};
}

Backend gauss_seidel_colored_row() {
  return {.name = "gauss_seidel_colored",
          .summary = "strain limiting: edges that share no vertex side by side in vectors",
          .knob = Knob::strain_limit,
          .contestant = true,
          .settings = setting_infos(GaussSeidelColored::fields()),
          .make_filter = make_filter<GaussSeidelColored>,
          .takes_middle = true,
          .direction = Direction::local,
          .citation = "Fratarcangeli, Tibaldo and Pellacini 2016",
          .origin = Origin::literature,
          .label = "Gauss-Seidel strain limiting, colored",
          .family = "gauss_seidel"};
}

}  // namespace inextensible
