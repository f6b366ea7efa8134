// How the time of a step grows with the number of vertices.
#include <cmath>

#include "harness/base/text.h"
#include "harness/claims/page.h"

namespace harness::claims {

void print_growth(std::ostream& out, const NamedResult& result) {
  for (const ScenePoints& scene : scenes_of(result.document, "resolution", false)) {
    PlaceTable best(scene.contestants());
    for (const Point& p : scene.points) {
      if (p.flag("best") && p.ok()) best.add(p.number("vertices"), p);
    }
    if (best.empty()) continue;
    out << "### " << scene.title << " (`" << result.name << "`)\n\n";
    print_head(out, {"solver", "sizes, vertices", "exponent (95 % interval)",
                     "a step at the largest, ms", "memory there, MiB"});
    for (const Role& role : best.contestants()) {
      std::vector<double> sizes, seconds;
      const Point* largest = nullptr;
      for (const double size : best.places()) {
        const Point* p = best.find(role.name, size);
        if (!p) continue;
        sizes.push_back(size);
        seconds.push_back(p->seconds() * p->number("step"));
        largest = p;
      }
      if (sizes.size() < 2) continue;
      const Slope slope = log_log_slope(sizes, seconds);
      std::string exponent = number_text(slope.value, 3);
      if (std::isfinite(slope.half_width))
        exponent +=
            " (" + number_text(slope.low(), 3) + " to " + number_text(slope.high(), 3) + ")";
      print_row(out, {quoted(role.name),
                      number_text(sizes.front(), 7) + " to " + number_text(sizes.back(), 7),
                      exponent, plain(1e3 * seconds.back(), 3),
                      plain(largest->number("peak_rss_bytes") / (1 << 20), 3)});
    }
    out << '\n';
  }
}

}  // namespace harness::claims
