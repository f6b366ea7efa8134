// Where the rim of a garment ends up.
#include "harness/base/text.h"
#include "harness/claims/page.h"
#include "harness/claims/slip.h"

namespace harness::claims {
namespace {

constexpr double frame = 1.0 / 30;  // s

}  // namespace

void print_slip(std::ostream& out, const NamedResult& result) {
  for (const ScenePoints& scene : scenes_of(result.document, "strain", true)) {
    const PlaceTable best = best_over_limits(scene, "garment");
    if (best.empty()) continue;
    out << "## Slip\n\n### " << scene.title << " (`" << result.name
        << "`)\n\nHow far the garment's rim is below the waist, where it began, mean over the last "
           "third of the run, of the way to the hips: above 100 % it has slipped past them. In "
           "brackets the time of computation for a frame of 1/30 s. Each solver at its best "
           "step.\n\n";
    best.print(
        out, [](double limit) { return percent(limit) + ", % (s)"; },
        [](const Point& p, double) {
          const Slip slip = slip_of(p);
          return plain(50 * (slip.least + slip.most), 3) + " (" + plain(frame * p.seconds(), 2) +
                 ")";
        });
  }
}

}  // namespace harness::claims
