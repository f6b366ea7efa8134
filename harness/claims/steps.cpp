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

struct Counts {
  int yes = 0, no = 0, all = 0;
  std::string told;
};

// At one place, where both have their fastest step.
void count_place(const Points& points, const Level& level, const Point& shake_best,
                 const Point& icd_best, Counts& counts) {
  const Steps steps = steps_of(points, shake_best, level.error),
              icd_steps = steps_of(points, icd_best, level.error);
  const Ratio costlier = ratio_of_steps(icd_best, shake_best);
  const Answer so = all_of({smaller(steps, icd_steps), above(costlier, 1)});
  ++counts.all;
  counts.yes += so == Answer::yes ? 1 : 0;
  counts.no += so == Answer::no ? 1 : 0;
  counts.told += "; " + text(shake_best.number("vertices"), 6) + " vertices at " +
                 percent(shake_best.number("strain_limit")) + ": SHAKE " +
                 steps.words(shake_best.number("step")) + ", ICD " +
                 icd_steps.words(icd_best.number("step")) + ", whose step takes " + text(costlier) +
                 " times as long";
}

void judge_steps(const Points& points, const Level& level, Ways& ways) {
  Counts counts;
  std::vector<Curve> evidence;
  for (const char* sweep : {"strain", "resolution"}) {
    const Curve icd_curve = points.best("drape", sweep, icd.name, level.error);
    Curve compared, compared_icd;
    for (const auto& [place, p] : points.best("drape", sweep, shake.name, level.error)) {
      const auto other = at(icd_curve, place);
      if (!other || std::isnan(p.error("energy_gain")) || std::isnan(other->error("energy_gain")))
        continue;
      count_place(points, level, p, *other, counts);
      compared.try_emplace(place, p);
      compared_icd.try_emplace(place, *other);
    }
    evidence.insert(evidence.end(), {compared, compared_icd});
  }
  if (counts.all == 0) return ways.add(level.words, not_measured, "");
  ways.add(level.words, verdict_of_counts(counts.yes, counts.no, counts.all),
           "so at " + std::to_string(counts.yes) + " of " + std::to_string(counts.all) +
               " places, not so at " + std::to_string(counts.no) + counts.told,
           evidence);
}

}  // namespace

void shake_small_steps(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the drape's strain and resolution sweeps, at every limit and size at which both SHAKE and "
      "ICD have a run whose error is at most 2 %: reproduced if at each of them SHAKE's fastest "
      "step is smaller than ICD's (all steps that the 95 % interval of their time cannot tell from "
      "the fastest counted in) and a step takes less time (interval of the ratio below 1); changed "
      "if at most of them, not reproduced if not at most of them, undecided if at half of them or "
      "if intervals leave it open. Beside it the same at any motion";
  Ways ways(c);
  for (const Level& level : claim_levels) judge_steps(points, level, ways);
}

}  // namespace harness::claims
