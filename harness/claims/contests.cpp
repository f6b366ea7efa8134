// C1 to C3, C5, C6, C11 and C15: which method is fast, how its time grows, and what its steps take.
#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/analysis/words.h"
#include "harness/base/text.h"
#include "harness/claims/judging.h"

namespace harness::claims {
namespace {

constexpr double one_percent = 0.01;
constexpr double paper_chain = 80;  // vertices

struct Way {
  std::string words;
  Curve springs, fast;
};

Way at_level(const Points& points, const std::string& sweep, const Level& level) {
  return {level.words, points.best("chain", sweep, implicit_springs.name, level.error),
          points.best("chain", sweep, fast_projection.name, level.error)};
}

std::string ratio_at(const Way& way, double x, const std::string& place) {
  const auto springs = at(way.springs, x), fast = at(way.fast, x);
  return springs && fast ? ", ratio " + text(ratio(*springs, *fast)) + " at " + place : "";
}

// How the ratio of times changes along the axis, and the ratio at both ends.
std::string told(const Way& way, const Slope& slope, std::string (*place)(double)) {
  std::string words = "slope of springs' time over fast projection's " + text(slope);
  std::vector<double> common;
  for (const auto& [x, point] : way.springs) {
    if (at(way.fast, x)) common.push_back(x);
  }
  return words + ratio_at(way, common.front(), place(common.front())) +
         ratio_at(way, common.back(), place(common.back()));
}

void judge_slopes(Ways& ways, const Way& way, Answer (*fast_is_better)(const Slope&, double),
                  std::string (*place)(double)) {
  const Slope slope = slope_of_ratio(way.springs, way.fast);
  if (slope.points < 3) {
    ways.add(way.words, not_measured, "");
  } else {
    ways.add(way.words, verdict_of(fast_is_better(slope, 0)), told(way, slope, place),
             {way.springs, way.fast});
  }
}

std::string vertices(double n) { return text(n, 6) + " vertices"; }

std::string apart(const Point& p) {
  const double iterations = p.work("iterations");
  return text(p.steps(), 5) + " steps of " + text(iterations / p.work("steps"), 2) +
         " iterations of " + text(1e6 * p.seconds() * p.number("duration") / iterations, 3) + " us";
}

}  // namespace

void chain_time_over_strain(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the time of implicit springs over that of fast projection, against the strain limit, each "
      "at "
      "its fastest step whose error is at most 2 % of the chain's length: reproduced if the "
      "log-log "
      "slope lies below 0 with its whole 95 % interval, not reproduced if above 0, undecided if it "
      "holds 0. Beside it the same at any motion, and against the error at any limit (step sweeps: "
      "least time within it)";
  Ways ways(c);
  for (const Level& level : claim_levels)
    judge_slopes(ways, at_level(points, "strain", level), below, percent);
  judge_slopes(
      ways,
      {"over the error at any limit", points.best_at_errors("chain", implicit_springs.name),
       points.best_at_errors("chain", fast_projection.name)},
      below, percent);
}

void chain_time_over_resolution(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the time of implicit springs over that of fast projection, against vertices, each at its "
      "fastest step whose error is at most 2 %: reproduced if the log-log slope lies above 0 with "
      "its whole 95 % interval, not reproduced if below 0, undecided if it holds 0. Beside it the "
      "same at any motion";
  Ways ways(c);
  for (const Level& level : claim_levels)
    judge_slopes(ways, at_level(points, "resolution", level), above, vertices);
}

void chain_speed(const Points& points, ClaimVerdict& c) {
  c.rule =
      "implicit springs' time over fast projection's at 1 % strain, each at its fastest step whose "
      "error is at most 2 %: reproduced if its 95 % interval lies between 12.5 and 50, changed if "
      "between 1 and 12.5 or above 50, not reproduced if below 1, undecided if it holds one of "
      "these bounds. Beside it the same at any motion";
  Ways ways(c);
  for (const Level& level : claim_levels) {
    const Way way = at_level(points, "strain", level);
    const auto springs = at(way.springs, one_percent), fast = at(way.fast, one_percent);
    if (!springs || !fast || springs->number("vertices") != paper_chain) {
      ways.add(way.words, not_measured, "");
      continue;
    }
    const Ratio slower = ratio(*springs, *fast);
    const auto inside = [&](double low, double high) {
      return slower.above(low) && slower.below(high);
    };
    const std::string verdict = inside(12.5, 50)                      ? reproduced
                                : inside(1, 12.5) || slower.above(50) ? changed
                                : slower.below(1)                     ? not_reproduced
                                                                      : undecided;
    ways.add(way.words, verdict,
             "ratio " + text(slower) + ": implicit springs " + apart(*springs) +
                 ", fast projection " + apart(*fast) +
                 " (the search for a stiffness is not charged)",
             {{{one_percent, *springs}}, {{one_percent, *fast}}});
  }
}

namespace {

// Answers to one question, and in how many places each was given.
class Tally {
 public:
  void add(Answer answer) { answers_.push_back(answer); }
  bool empty() const { return answers_.empty(); }
  Answer all() const { return all_of(answers_); }
  std::string words() const {
    const auto count = [&](Answer one) {
      return std::to_string(std::count(answers_.begin(), answers_.end(), one));
    };
    return count(Answer::yes) + " of " + std::to_string(answers_.size()) +
           (all() == Answer::yes ? ""
                                 : " (" + count(Answer::no) + " the other way, " +
                                       count(Answer::open) + " undecided)");
  }

 private:
  std::vector<Answer> answers_;
};

// Whether a is faster than b at a place that b reached.
Answer faster(const Curve& a, double place, const Point& b) {
  const auto here = at(a, place);
  return here ? above(ratio(b, *here), 1) : Answer::no;
}

// The loosest limit from which on `fast` is ahead of all these curves beyond the noise.
std::string ahead_from(const Curve& fast, const std::vector<Curve>& others) {
  std::string from = "nowhere";
  for (const auto& place : fast) {
    const auto& limit = place.first;  // not a structured binding: Clang 14 captures none
    const auto& point = place.second;
    const bool ahead = std::all_of(others.begin(), others.end(), [&](const Curve& other) {
      const auto there = at(other, limit);
      return !there || above(ratio(*there, point), 1) == Answer::yes;
    });
    if (!ahead) break;
    from = "from " + percent(limit) + " down";
  }
  return from;
}

// The fastest of all contestants, at each place of fast projection's curve: "yarn_projection at 10
// %, 1
// %; icd at 0.1 %".
std::string first_of_all(const Points& points, const std::string& sweep, const Curve& fast,
                         double level, const std::function<std::string(double)>& words,
                         std::optional<double> vertices = {}) {
  std::vector<std::pair<std::string, Curve>> curves;
  for (const Role& one : points.ranked("drape", sweep, vertices))
    curves.emplace_back(one.name, points.best("drape", sweep, one.name, level, vertices));
  std::vector<std::pair<std::string, std::string>> told;  // name, places
  for (const auto& entry : fast) {
    std::string name;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [contestant, curve] : curves) {
      const auto here = at(curve, entry.first);
      if (!here || here->seconds() >= least) continue;
      least = here->seconds();
      name = contestant;
    }
    if (told.empty() || told.back().first != name) {
      told.emplace_back(name, words(entry.first));
    } else {
      told.back().second += ", " + words(entry.first);
    }
  }
  std::string all;
  for (const auto& [name, places] : told) all += (all.empty() ? "" : "; ") + name + " at " + places;
  return all;
}

// C5 at one size; false: there is too little to judge it by. Strain limiting in a random order is
// stopped where it is far behind, so that it may have no slope at a large size.
bool judge_over_strain(const Points& points, const Level& level, double vertices, Ways& ways) {
  const auto curve_of = [&](const PaperMethod& method) {
    return points.best("drape", "strain", method.name, level.error, vertices);
  };
  const Curve fast = curve_of(fast_projection);
  const std::vector<Curve> limiting{curve_of(jacobi), curve_of(gauss_seidel)};
  std::vector<Curve> evidence = limiting;
  Tally flatter, fastest;
  std::string slopes;
  for (const PaperMethod& method : {shake, icd, fast_projection}) {
    const Curve curve = curve_of(method);
    if (curve.size() >= 3) {
      slopes +=
          (slopes.empty() ? "" : ", ") + std::string(method.words) + " " + text(slope_of(curve));
      evidence.push_back(curve);
      for (const Curve& other : limiting) {
        const Slope slope = slope_of_ratio(other, curve);
        if (slope.points >= 3) flatter.add(below(slope, 0));
      }
    }
    if (method.name == fast_projection.name) continue;
    for (const auto& [limit, point] : curve) fastest.add(faster(fast, limit, point));
  }
  if (fast.size() < 3 || flatter.empty() || fastest.empty()) return false;
  ways.add(level.words, verdict_of(flatter.all(), fastest.all()),
           text(vertices, 6) + " vertices: flatter in " + flatter.words() +
               " pairs (slopes: " + slopes + "), fast projection fastest in " + fastest.words() +
               " comparisons, and ahead of all strain limiting " + ahead_from(fast, limiting) +
               "; fastest of all, ours and rivals too: " +
               first_of_all(points, "strain", fast, level.error, percent, vertices),
           evidence);
  return true;
}

void judge_over_resolution(const Points& points, const Level& level, Ways& ways) {
  const Curve fast = points.best("drape", "resolution", fast_projection.name, level.error);
  std::string told;
  std::vector<Answer> sizes;
  for (const auto& [vertices, point] : fast) {
    std::vector<Answer> here;
    std::string rival;
    Ratio closest;
    for (const PaperMethod& method : all_paper_methods) {
      if (method.name == fast_projection.name) continue;
      const auto other = at(points.best("drape", "resolution", method.name, level.error), vertices);
      if (!other) continue;
      const Ratio slower = ratio(*other, point);
      here.push_back(above(slower, 1));
      if (rival.empty() || slower.value < closest.value) {
        closest = slower;
        rival = method.words;
      }
    }
    if (here.empty()) continue;
    sizes.push_back(all_of(here));
    const char* word = sizes.back() == Answer::yes  ? "fastest"
                       : sizes.back() == Answer::no ? "not fastest"
                                                    : "undecided";
    told += (told.empty() ? "" : ", ") + text(vertices, 6) + ": " + word + ", " + rival +
            " takes " + text(closest) + " of its time";
  }
  if (fast.size() < 2 || sizes.empty()) return ways.add(level.words, not_measured, "");
  const Answer all = all_of(sizes), largest = sizes.back();
  std::string verdict = largest == Answer::yes && all == Answer::no ? changed
                        : largest == Answer::no                     ? not_reproduced
                                                                    : verdict_of(all);
  if (largest == Answer::open) verdict = undecided;
  ways.add(level.words, verdict,
           told + "; fastest of all, ours and rivals too: " +
               first_of_all(points, "resolution", fast, level.error,
                            [](double n) { return text(n, 6); }),
           {fast});
}

}  // namespace

void drape_time_over_strain(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the paper's six methods, each at its fastest step whose error is at most 2 %; (a) of each "
      "pair of one of SHAKE, ICD and fast projection and one of Jacobi and Gauss-Seidel, the time "
      "of "
      "the latter over that of the former grows as the limit falls (log-log slope below 0 with its "
      "95 % interval); (b) fast projection takes less time than SHAKE and ICD at every limit that "
      "these reach (interval of the ratio above 1), at the largest size at which three limits are "
      "met by all that a slope needs; both: reproduced, one: changed, none: not "
      "reproduced, undecided if an interval of an (otherwise true) part holds the bound. Beside it "
      "the same at any motion";
  Ways ways(c);
  const std::vector<double> sizes = points.sizes("drape", "strain");
  for (const Level& level : claim_levels) {
    const bool judged = std::any_of(sizes.begin(), sizes.end(), [&](double vertices) {
      return judge_over_strain(points, level, vertices, ways);
    });
    if (!judged) ways.add(level.words, not_measured, "");
  }
}

void drape_time_over_resolution(const Points& points, ClaimVerdict& c) {
  c.rule =
      "against the others of the paper's six methods, each at its fastest step whose error is at "
      "most 2 %: reproduced if fast projection takes less time than each at every size (95 % "
      "interval "
      "of the ratio above 1), changed if at the largest but not at all, not reproduced if not at "
      "the "
      "largest; undecided if an interval that this hangs on holds 1. Beside it the same at any "
      "motion";
  Ways ways(c);
  for (const Level& level : claim_levels) judge_over_resolution(points, level, ways);
}

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
