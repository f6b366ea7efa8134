#include "harness/claims/sag.h"

#include <cmath>
#include <map>

#include "harness/claims/paper_methods.h"

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
  std::map<std::string, std::map<double, double>> hangs;  // method -> limit -> sag over side
  for (const Point& p : points.where([](const Point& q) {
         return q.is("scene", "hung_patch") && q.ok() && q.flag("best");
       })) {
    for (const PaperMethod& method :
         {implicit_springs, jacobi, gauss_seidel, shake, icd, fast_projection}) {
      if (p.contestant() != method.name) continue;
      hangs[method.words][p.number("strain_limit")] =
          p.document().at("sag").at("lower_edge").get<double>() / p.scene_parameter("side");
      c.points.push_back(p.id());
    }
  }
  int all = 0, seen = 0;
  for (const auto& [words, sag] : hangs) {
    const auto loose = sag.find(0.1), middle = sag.find(0.01), tight = sag.find(0.001);
    if (loose == sag.end() || middle == sag.end() || tight == sag.end()) continue;
    ++all;
    const double first = loose->second - middle->second, second = middle->second - tight->second;
    seen += first >= visible && second >= visible;
    c.measured += (c.measured.empty() ? "lower by " : ", ") + percent(first) + " and " +
                  percent(second) + " of the side with " + words;
  }
  if (all == 0) return;
  c.verdict = seen == all ? reproduced : seen == 0 ? not_reproduced : changed;
}

}  // namespace harness::claims
