// Time over permitted strain and over resolution: each contestant at its best step.
#include "harness/base/text.h"
#include "harness/claims/page.h"
#include "harness/claims/paper_methods.h"

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
    PlaceTable best(scene.contestants());
    for (const Point& p : scene.points) {
      if (p.flag("best") && p.ok()) best.add(p.number(strain ? "strain_limit" : "vertices"), p);
    }
    if (best.empty()) continue;
    if (strain) best.loose_to_tight();
    const auto place = [&](double at) {
      return strain ? percent(at) : number_text(at, 7) + " vertices";
    };
    const std::string reference = fast_projection.name;
    out << "### " << scene.title << " (`" << result.name << "`)\n\n"
        << "Seconds of computation for one simulated second, each solver at its best step:\n\n";
    best.print(
        out, [&](double at) { return place(at) + ", s"; },
        [&](const Point& p, double at) {
          const std::string seconds = plain(p.seconds(), 3);
          const Point* first = best.clear_best(at);
          return first && first->contestant() == p.contestant() ? bold(seconds) : seconds;
        });
    out << "The same, over the time of " << fast_projection.words << " (above 1: slower):\n\n";
    best.print(
        out, [&](double at) { return place(at) + ", ratio"; },
        [&](const Point& p, double at) {
          const Point* fast = best.find(reference, at);
          if (!fast) return std::string("-");
          return p.contestant() == reference ? std::string("1") : text(ratio(p, *fast));
        });
    out << "The steps these are:\n\n";
    best.print(
        out, [&](double at) { return place(at) + ", step in s"; },
        [](const Point& p, double) { return step_words(p); });
    print_beside(out, scene, best, place);
  }
}

}  // namespace harness::claims
