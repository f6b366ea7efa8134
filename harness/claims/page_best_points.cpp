// Time over permitted strain and over resolution: each contestant at its best step.
#include "harness/analysis/paper_methods.h"
#include "harness/analysis/plane.h"
#include "harness/base/text.h"
#include "harness/claims/page.h"

namespace harness::claims {
namespace {

// "1/25 (coarsest)": the step at which the ladder ends.
std::string step_words(const Point& p) {
  const std::string end = p.document().value("at_ladder_end", "");
  return step_text(p.number("step")) + (end.empty() ? "" : " (" + end + ")");
}

}  // namespace

void print_best_points(std::ostream& out, const NamedResult& result, const std::string& sweep) {
  const bool strain = sweep == "strain";
  for (const ScenePoints& scene : scenes_of(result.document, sweep, strain)) {
    PlaceTable best(scene.ranked()), own(scene.contestants());
    std::map<std::pair<double, std::string>, std::vector<const Point*>> places;
    for (const Point& p : scene.points)
      places[{p.number(strain ? "strain_limit" : "vertices"), p.contestant()}].push_back(&p);
    for (const auto& [place, points] : places) {
      const Point* answer = fastest_of(points, any_motion);
      if (!answer) continue;
      own.add(place.first, *answer);
      best.add(place.first, *answer, scene.cast.at_any_settings(answer->contestant()));
    }
    if (best.empty()) continue;
    if (strain) own.loose_to_tight();
    if (strain) best.loose_to_tight();
    const auto place = [&](double at) {
      return strain ? percent(at) : number_text(at, 7) + " vertices";
    };
    const std::string reference = fast_projection.name;
    out << "### " << scene.title << " (`" << result.name << "`)\n\n"
        << "Seconds of computation for one simulated second, each solver at its best step, with "
           "its "
           "tuned settings or, where that is faster, `u`, its untuned ones:\n\n";
    best.print(
        out, [&](double at) { return place(at) + ", s"; },
        [&](const Point& p, double at) {
          const std::string seconds = plain(p.seconds(), 3);
          const Point* first = best.clear_best(at);
          const bool clear = first && first->contestant() == p.contestant();
          return (clear ? bold(seconds) : seconds) + (scene.untuned(p) ? " `u`" : "");
        });
    out << "The same, over the time of " << fast_projection.words << " (above 1: slower):\n\n";
    best.print(
        out, [&](double at) { return place(at) + ", ratio"; },
        [&](const Point& p, double at) {
          const Point* fast = best.find(reference, at);
          if (!fast) return std::string("-");
          return p.contestant() == fast->contestant() ? std::string("1") : text(ratio(p, *fast));
        });
    out << "The steps these are, and the errors of these motions:\n\n";
    best.print(
        out, [&](double at) { return place(at) + ", step in s, error"; },
        [](const Point& p, double) {
          const double error = p.error_at(headline_error).distance;
          return step_words(p) + ", " + (std::isfinite(error) ? percent(error) : "-");
        });
    print_beside(out, scene, best, own, place);
  }
}

}  // namespace harness::claims
