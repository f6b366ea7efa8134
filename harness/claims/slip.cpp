#include "harness/claims/slip.h"

#include <algorithm>

#include "harness/analysis/paper_methods.h"

namespace harness::claims {

Slip slip_of(const Point& point) {
  const nlohmann::json& sag = point.document().at("sag");
  const double drop = point.scene_parameter("drop");
  const double rim = sag.at("rim").get<double>(), across = sag.at("rim_across").get<double>();
  return {std::min(rim, across) / drop, std::max(rim, across) / drop};
}

void garment_slip(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the garment, each of the paper's methods at its best step, mean over the last third of the "
      "run: its rim is to stay above the body's hips at 1 %, and to be below them at 10 %; "
      "reproduced if so with every method that has both, not reproduced if with none, else changed";
  std::vector<std::string> verdicts;
  for (const PaperMethod& method : all_paper_methods) {
    const Curve best = points.best("garment", "strain", method.name);
    cite(c, best);
    const auto loose = at(best, 0.1), tight = at(best, 0.01);
    if (!loose || !tight) continue;
    const Slip slides = slip_of(*loose), stays = slip_of(*tight);
    verdicts.push_back(stays.held() && slides.past() ? reproduced : not_reproduced);
    c.measured += (c.measured.empty() ? "rim below the waist, of the way to the hips: " : "; ") +
                  std::string(method.words) + " " + percent(stays.most) + " at 1 %, " +
                  percent(slides.least) + " at 10 %";
  }
  c.verdict = verdict_of_all(verdicts);
}

}  // namespace harness::claims
