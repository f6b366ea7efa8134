// Jacobi strain limiting (Provot 1995; Bridson, Fedkiw and Anderson 2002): all edges corrected from
// the same state, the corrections averaged, until the maximum strain is permissible.
//
// Averaging: edge k's correction is divided by the mean valence of its ends, weighted by their
// inverse masses,
//   omega_k = (w_a + w_b) / (w_a deg_a + w_b deg_b),
// the same factor at both ends, so momentum is kept (dividing by each vertex's own valence would
// not). Linearized, the pass is x -= W J^T S J x with every row of S J W J^T summing in absolute
// value to at most 1, hence all its eigenvalues lie in [0, 1]: it converges at any valence and any
// masses, and up to relaxation 2. The default, 1.8, takes about a third fewer passes than the plain
// average on the drape.
//
// All edges are independent, so that they are done in colors (strain_passes.cpp) and summed
// without conflicts. A pass that corrects nothing is the test of convergence and is not counted.
// Loops: one pass over edges, one over vertices.
#include "solvers/methods/rows.h"
#include "solvers/methods/strain_limiting.h"

namespace inextensible {
namespace {

StrainPasses averaged(const Problem& problem, const LimiterSettings& settings) {
  std::vector<int> valence(problem.vertices(), 0);
  for (const auto [a, b] : problem.edges()) {
    ++valence[a];
    ++valence[b];
  }
  std::vector<double> share_a, share_b;
  for (const auto [a, b] : problem.edges()) {
    const double wa = problem.inverse_mass()[a], wb = problem.inverse_mass()[b];
    const double share = settings.relaxation / (wa * valence[a] + wb * valence[b]);
    share_a.push_back(wa * share);
    share_b.push_back(wb * share);
  }
  return {problem, {settings.strain_limit, settings.target}, share_a, share_b};
}

class Jacobi final : public PassLimiter<StrainPasses::Order::at_once> {
 public:
  Jacobi(const Problem& problem, const Settings& settings, Along along)
      : PassLimiter(problem, settings, averaged(problem, settings), along) {}
};

}  // namespace

Backend jacobi_row() {
  return {.name = "jacobi",
          .summary = "strain limiting: all edges corrected at once, averaged",
          .strain_control = StrainControl::strain_limit,
          .contestant = true,
          .settings = setting_infos(Jacobi::fields(), {.relaxation = 1.8}),
          .make_filter = make_filter<Jacobi>,
          .takes_middle = true,
          .direction = Direction::local,
          .citation = "Provot 1995; Bridson, Fedkiw and Anderson 2002",
          .origin = Origin::paper,
          .label = "Jacobi strain limiting"};
}

}  // namespace inextensible
