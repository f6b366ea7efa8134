// Least time to stay within an error.
#include <algorithm>
#include <cmath>

#include "harness/base/text.h"
#include "harness/claims/page.h"

namespace harness::claims {
namespace {

// What errors of these points mean: up to when, and how sure the reference is.
std::string errors_are(const std::vector<Point>& points) {
  double until = std::nan(""), gap = 0;
  bool series = false;
  for (const Point& p : points) {
    gap = std::fmax(gap, p.error("gap"));
    until = std::fmax(until, p.error("valid_until"));
    const auto& error = p.document().at("error");
    series = series || error.contains("error_series");
  }
  const std::string words = "Errors are root mean squares over the scene's size, ";
  if (series)
    return words +
           "over the sample times at which three times the reference's own uncertainty is "
           "below the column's error.";
  return words + "up to " + number_text(until, 3) + " s; the reference is sure to " +
         percent(3 * gap) + ".";
}

// The last sample time at which the reference is sure enough for a level; not-a-number for older
// files, where that time is one for all levels.
double sure_until(const std::vector<Point>& points, double level) {
  double until = std::nan("");
  for (const Point& p : points) {
    const auto& error = p.document().at("error");
    for (const auto& sample : error.value("error_series", nlohmann::json::array())) {
      if (sample.at(3).is_number() && 3 * sample.at(3).get<double>() <= level)
        until = std::fmax(until, sample.at(0).get<double>());
    }
  }
  return until;
}

}  // namespace

void print_time_to_error(std::ostream& out, const NamedResult& result) {
  for (const ScenePoints& scene : scenes_of(result.document, "step", true)) {
    PlaceTable fastest(scene.ranked());
    for (const Point& p : scene.points) {
      for (const double level : error_levels) {
        if (p.ok() && p.within_error(level))
          fastest.add(level, p, scene.cast.at_any_settings(p.contestant()));
      }
    }
    // Without a reference, or a rival, there is nothing to compare.
    if (fastest.empty() || fastest.contestants().size() < 2) continue;
    fastest.loose_to_tight();
    out << "### " << scene.title << " (`" << result.name << "`)\n\n"
        << "Least time for one simulated second to stay within an error, and the step that does "
           "it, at any strain limit, with a solver's tuned settings or `u`, its untuned ones. "
        << errors_are(scene.points) << "\n\n";
    fastest.print(
        out,
        [&](double level) {
          const double until = sure_until(scene.points, level);
          const std::string when =
              std::isfinite(until) ? ", up to " + number_text(until, 3) + " s" : "";
          return percent(level) + when + ": time in ms, step in s";
        },
        [&](const Point& p, double level) {
          const std::string time = plain(1e3 * p.seconds(), 3);
          const Point* first = fastest.clear_best(level);
          const bool clear = first && first->contestant() == p.contestant();
          return (clear ? bold(time) : time) + ", " + step_text(p.number("step")) +
                 (scene.untuned(p) ? " `u`" : "");
        });
  }
}

}  // namespace harness::claims
