#include "harness/claims/sag.h"

#include <cmath>

#include "harness/analysis/paper_methods.h"

namespace harness::claims {
namespace {

constexpr double visible = 0.01;  // of the patch's side

}  // namespace

double parabola_sag(double length, double strain) {
  // Over the length, with a = 4 sag / length: (sqrt(1 + a^2) + asinh(a) / a) / 2.
  const auto arc = [](double a) {
    return a > 0 ? 0.5 * (std::sqrt(1 + a * a) + std::asinh(a) / a) : 1;
  };
  double low = 0, high = 4 * (1 + strain);  // the arc is longer than a / 2
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (arc(middle) < 1 + strain ? low : high) = middle;
  }
  return 0.25 * length * low;
}

void patch_sag(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the hung patch, each of the paper's methods at its best step, mean over the last of three "
      "seconds: how much lower the middle of its lower edge hangs at 10 % than at 1 %, and there "
      "than at 0.1 %; reproduced if both are at least 1 % of the side for every method that has "
      "all three, not reproduced if for none, else changed";
  const auto hangs = [](const Point& p) {
    return p.document().at("sag").at("lower_edge").get<double>() / p.scene_parameter("side");
  };
  std::vector<std::string> verdicts;
  for (const PaperMethod& method : all_paper_methods) {
    const Curve best = points.best("hung_patch", "strain", method.name);
    cite(c, best);
    const auto loose = at(best, 0.1), middle = at(best, 0.01), tight = at(best, 0.001);
    if (!loose || !middle || !tight) continue;
    const double first = hangs(*loose) - hangs(*middle), second = hangs(*middle) - hangs(*tight);
    verdicts.push_back(first >= visible && second >= visible ? reproduced : not_reproduced);
    c.measured += (c.measured.empty() ? "lower by " : ", ") + percent(first) + " and " +
                  percent(second) + " of the side with " + method.words;
  }
  c.verdict = verdict_of_all(verdicts);
}

}  // namespace harness::claims
