// C5 and C6: fast projection against the others of the paper's six methods on the drape; which
// others is ahead is told apart.
#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "harness/analysis/paper_methods.h"
#include "harness/claims/contests.h"
#include "harness/claims/ways.h"

namespace harness::claims {
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

// The fastest of all contestants, at each place of fast projection's curve: "strips at 10 %, 1
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

}  // namespace harness::claims
