// The second ranking: by the strain that is left after the collision filter.
#include <algorithm>
#include <array>
#include <cmath>

#include "harness/base/text.h"
#include "harness/claims/page.h"

namespace harness::claims {
namespace {

constexpr std::array delivered_levels{1.0,  0.5,  0.3,   0.2,   0.1,   0.05,
                                      0.02, 0.01, 0.005, 0.002, 0.001, 0.0001};

}  // namespace

void print_delivered(std::ostream& out, const NamedResult& result) {
  for (const ScenePoints& scene : scenes_of(result.document, "strain", true)) {
    if (!scene.has_collider()) continue;
    PlaceTable fastest(scene.ranked());
    double least = 1;
    for (const Point& p : scene.points) {
      const double strain = p.delivered_strain();
      if (!p.ok() || !p.timed()) continue;
      least = std::min(least, strain);
      for (const double level : delivered_levels) {
        if (strain <= level) fastest.add(level, p, scene.cast.at_any_settings(p.contestant()));
      }
    }
    if (fastest.empty()) continue;
    fastest.loose_to_tight();
    fastest.drop_repeated_places();
    out << "### " << scene.title << " (`" << result.name << "`)\n\n"
        << "Least time for one simulated second whose largest strain after the collision filter "
           "is at most that of the column, at any permitted strain and step that was tried, and "
           "that step, with tuned settings or `u`, untuned ones. The least such strain of any run: "
        << percent(least) << ".\n\n";
    fastest.print(
        out, [](double level) { return percent(level) + ": time in s, step in s"; },
        [&](const Point& p, double level) {
          const std::string seconds = plain(p.seconds(), 3);
          const Point* first = fastest.clear_best(level);
          const bool clear = first && first->contestant() == p.contestant();
          return (clear ? bold(seconds) : seconds) + ", " + step_text(p.number("step")) +
                 (scene.untuned(p) ? " `u`" : "");
        });
  }
}

}  // namespace harness::claims
