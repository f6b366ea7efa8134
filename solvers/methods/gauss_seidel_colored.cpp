// Gauss-Seidel strain limiting in colors: as gauss_seidel, but edges that share no vertex are
// corrected side by side, as limiters for parallel processors do (Fratarcangeli, Tibaldo and
// Pellacini 2016).
//
// Within a color no edge sees another's correction, so that a pass equals one that visits edges
// one after the other, color after color. The order is the same in every pass; the random one of
// gauss_seidel takes about a third more passes. What colors win on one processor is vectors, see
// strain_passes.cpp.
//
// A pass that corrects nothing has seen every edge in its final place: it is the test of
// convergence, and is not counted. Loops: one pass over edges.
#include "solvers/methods/rows.h"
#include "solvers/methods/strain_limiting.h"

namespace inextensible {
namespace {

class GaussSeidelColored final : public PassLimiter<StrainPasses::Order::in_turn> {
 public:
  GaussSeidelColored(const Problem& problem, const Settings& s, Along along)
      : PassLimiter(problem, s,
                    StrainPasses::by_mass(problem, {s.strain_limit, s.target}, s.relaxation),
                    along) {}
};

}  // namespace

Backend gauss_seidel_colored_row() {
  return {.name = "gauss_seidel_colored",
          .summary = "strain limiting: edges that share no vertex side by side in vectors",
          .strain_control = StrainControl::strain_limit,
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
