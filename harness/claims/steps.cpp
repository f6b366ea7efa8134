#include "harness/claims/steps.h"

#include <algorithm>
#include <map>
#include <string>

#include "harness/analysis/paper_methods.h"
#include "harness/base/text.h"
#include "harness/claims/ways.h"

namespace harness::claims {

void matrix_sizes(const Points& points, ClaimVerdict& c) {
  c.rule =
      "at each drape size that both ran, ICD with its own matrix factored (projected conjugate "
      "gradients factor fast projection's): reproduced if ICD's factor has more nonzeros; the "
      "matrices are 2 n and 5 n wide by construction";
  std::map<double, std::pair<double, double>> nonzeros;  // vertices -> fast projection, ICD
  for (const Point& p : points.where([](const Point& q) {
         return q.is("scene", "drape") && q.ok() && q.work("factor_nonzeros") > 0 &&
                !q.solves_by("projected_cg") && !q.solves_by("hybrid");
       })) {
    auto& pair = nonzeros[p.number("vertices")];
    double* place = p.contestant() == fast_projection.name ? &pair.first
                    : p.contestant() == icd.name           ? &pair.second
                                                           : nullptr;
    if (!place) continue;
    if (*place == 0) c.points.push_back(p.id());
    *place = p.work("factor_nonzeros");
  }
  bool all = true;
  for (const auto& [vertices, pair] : nonzeros) {
    if (pair.first == 0 || pair.second == 0) continue;
    c.measured +=
        (c.measured.empty() ? "nonzeros of ICD's factor over fast projection's: " : ", ") +
        text(pair.second / pair.first, 2) + " at " + text(vertices, 6) + " vertices";
    all = all && pair.second > pair.first;
  }
  if (!c.measured.empty()) c.verdict = all ? reproduced : not_reproduced;
}

namespace {

// The steps that cannot be told from the best one by their time.
struct Steps {
  double smallest, largest;  // s

  std::string words(double best) const {
    return step_text(best) + " s" +
           (smallest < largest ? " (" + step_text(smallest) + " to " + step_text(largest) + ")"
                               : "");
  }
};

Steps steps_of(const Points& points, const Point& best, double level) {
  Steps steps{best.number("step"), best.number("step")};
  for (const Point& p : points.where([&](const Point& q) {
         return q.ok() && q.timed() && q.contestant() == best.contestant() &&
                q.is("scene", best.text("scene")) && q.is("sweep", best.text("sweep")) &&
                q.number("vertices") == best.number("vertices") &&
                q.number("strain_limit") == best.number("strain_limit") && q.within_error(level);
       })) {
    if (p.id() != best.id() && above(ratio(p, best), 1) == Answer::yes) continue;
    steps.smallest = std::min(steps.smallest, p.number("step"));
    steps.largest = std::max(steps.largest, p.number("step"));
  }
  return steps;
}

Answer smaller(const Steps& a, const Steps& b) {
  if (a.largest < b.smallest) return Answer::yes;
  return a.smallest >= b.largest ? Answer::no : Answer::open;
}

std::string verdict_of_counts(int yes, int no, int all) {
  if (yes == all) return reproduced;
  if (2 * (all - no) <= all) return not_reproduced;
  return no > 0 && 2 * yes > all ? changed : undecided;
}

void judge_steps(const Points& points, const Level& level, Ways& ways) {
  int yes = 0, no = 0, all = 0;
  std::string example;
  std::vector<Curve> evidence;
  for (const char* scene : {"chain", "drape"}) {
    const auto icd_curve = points.best(scene, "strain", icd.name, level.error);
    Curve compared, compared_icd;
    for (const auto& [limit, p] : points.best(scene, "strain", shake.name, level.error)) {
      const auto other = at(icd_curve, limit);
      if (!other || std::isnan(p.error("energy_gain")) || std::isnan(other->error("energy_gain")))
        continue;
      const Steps steps = steps_of(points, p, level.error),
                  icd_steps = steps_of(points, *other, level.error);
      const Ratio costlier = ratio_of_steps(*other, p);
      const Answer so = all_of({smaller(steps, icd_steps), above(costlier, 1)});
      ++all;
      yes += so == Answer::yes ? 1 : 0;
      no += so == Answer::no ? 1 : 0;
      compared.try_emplace(limit, p);
      compared_icd.try_emplace(limit, *other);
      if (std::abs(limit - 0.01) < 1e-9)
        example += std::string(", ") + scene + " at 1 %: SHAKE " + steps.words(p.number("step")) +
                   ", ICD " + icd_steps.words(other->number("step")) + ", whose step takes " +
                   text(costlier) + " times as long";
    }
    evidence.insert(evidence.end(), {compared, compared_icd});
  }
  if (all == 0) return ways.add(level.words, not_measured, "");
  ways.add(level.words, verdict_of_counts(yes, no, all),
           "so at " + std::to_string(yes) + " of " + std::to_string(all) + " limits, not so at " +
               std::to_string(no) + example,
           evidence);
}

}  // namespace

void shake_small_steps(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the fastest steps of the strain sweeps whose error is at most 2 %: reproduced if at every "
      "limit SHAKE's step is smaller than ICD's (all steps that the 95 % interval of their time "
      "cannot tell from the fastest counted in) and a step takes less time (interval of the ratio "
      "below 1); changed if at most limits, not reproduced if not at half of them, undecided if "
      "intervals leave it open. Beside it the same at any motion";
  Ways ways(c);
  for (const Level& level : claim_levels) judge_steps(points, level, ways);
}

}  // namespace harness::claims
