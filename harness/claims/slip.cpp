#include "harness/claims/slip.h"

#include <algorithm>
#include <map>

#include "harness/claims/paper_methods.h"

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
  std::map<std::string, std::map<double, Slip>> slips;  // method -> limit
  for (const Point& p : points.where(
           [](const Point& q) { return q.is("scene", "garment") && q.ok() && q.flag("best"); })) {
    for (const PaperMethod& method :
         {implicit_springs, jacobi, gauss_seidel, shake, icd, fast_projection}) {
      if (p.contestant() != method.name) continue;
      slips[method.words].insert_or_assign(p.number("strain_limit"), slip_of(p));
      c.points.push_back(p.id());
    }
  }
  int all = 0, seen = 0;
  for (const auto& [words, slip] : slips) {
    const auto loose = slip.find(0.1), tight = slip.find(0.01);
    if (loose == slip.end() || tight == slip.end()) continue;
    ++all;
    seen += tight->second.held() && loose->second.past();
    c.measured += (c.measured.empty() ? "rim below the waist, of the way to the hips: " : "; ") +
                  words + " " + percent(tight->second.most) + " at 1 %, " +
                  percent(loose->second.least) + " at 10 %";
  }
  if (all == 0) return;
  c.verdict = seen == all ? reproduced : seen == 0 ? not_reproduced : changed;
}

}  // namespace harness::claims
