// How far marked vertices sag.
#include "harness/base/text.h"
#include "harness/claims/page.h"
#include "harness/claims/sag.h"

namespace harness::claims {

void print_sag(std::ostream& out, const NamedResult& result) {
  for (const ScenePoints& scene : scenes_of(result.document, "strain", true)) {
    const PlaceTable best = best_over_limits(scene, "hung_patch");
    if (best.empty()) continue;
    const double side = scene.points.front().scene_parameter("side");
    out << "## Sag\n\n### " << scene.title << " (`" << result.name << "`)\n\n"
        << "How far the middle of the top row, and that of the lower edge, hang below where they "
           "would if nothing stretched, mean over the last third of the run, each solver at its "
           "best step; in brackets how fast it still moves. A top row that "
           "uses up its strain and bears an even load is a parabola, which sags by ";
    bool first = true;
    for (const double limit : best.places()) {
      out << (first ? "" : ", ") << plain(1e3 * parabola_sag(side, limit), 3) << " mm at "
          << percent(limit);
      first = false;
    }
    out << ".\n\n";
    best.print(
        out, [](double limit) { return percent(limit) + ", mm (m/s)"; },
        [](const Point& p, double) {
          const nlohmann::json& sag = p.document().at("sag");
          return plain(1e3 * sag.at("top_row").get<double>(), 3) + ", " +
                 plain(1e3 * sag.at("lower_edge").get<double>(), 3) + " (" +
                 plain(p.number("rest_speed"), 2) + ")";
        });
  }
}

}  // namespace harness::claims
