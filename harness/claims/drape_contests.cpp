// C5 and C6: fast projection against all others on the drape.
#include <algorithm>
#include <string>
#include <vector>

#include "harness/analysis/paper_methods.h"
#include "harness/claims/contests.h"

namespace harness::claims {
namespace {

// Contestants of the families of some of the paper's methods, in the files' order.
std::vector<std::string> of_families(const Points& points, const std::string& sweep,
                                     const std::vector<PaperMethod>& methods) {
  std::vector<std::string> names;
  for (const Role& one : points.ranked("drape", sweep)) {
    if (std::any_of(methods.begin(), methods.end(),
                    [&](const auto& m) { return points.same_family(one.name, m.name); }))
      names.push_back(one.name);
  }
  return names;
}

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

}  // namespace

void drape_time_over_strain(const Points& points, ClaimVerdict& c) {
  c.rule =
      "all tuned contestants of the paper's families; (a) of each pair of one of SHAKE, ICD and "
      "fast projection and one that limits strain edge by edge, the time of the latter over that "
      "of the former grows as the limit falls (log-log slope below 0 with its 95 % interval); (b) "
      "fast projection takes less time than each of SHAKE's and ICD's families at every limit that "
      "these reach (interval of the ratio above 1); both: reproduced, one: changed, none: not "
      "reproduced, undecided if an interval of an (otherwise true) part holds the bound";
  const Curve fast = points.best("drape", "strain", fast_projection.name);
  std::vector<Curve> limiting;
  for (const std::string& name : of_families(points, "strain", {jacobi, gauss_seidel}))
    limiting.push_back(points.best("drape", "strain", name));
  Tally flatter, fastest;
  std::string slopes;
  for (const PaperMethod& method : {shake, icd, fast_projection}) {
    const Curve curve = points.best("drape", "strain", method.name);
    if (curve.size() < 3) continue;
    slopes +=
        (slopes.empty() ? "" : ", ") + std::string(method.words) + " " + text(slope_of(curve));
    cite(c, curve);
    for (const Curve& other : limiting) {
      const Slope slope = slope_of_ratio(other, curve);
      if (slope.points >= 3) flatter.add(below(slope, 0));
    }
  }
  for (const std::string& name : of_families(points, "strain", {shake, icd})) {
    for (const auto& [limit, point] : points.best("drape", "strain", name))
      fastest.add(faster(fast, limit, point));
  }
  if (fast.size() < 3 || flatter.empty() || fastest.empty()) return;
  for (const Curve& other : limiting) cite(c, other);
  c.measured = "flatter in " + flatter.words() + " pairs (slopes: " + slopes +
               "); fast projection fastest in " + fastest.words() +
               " comparisons, and ahead of all strain limiting " + ahead_from(fast, limiting);
  c.verdict = verdict_of(flatter.all(), fastest.all());
}

void drape_time_over_resolution(const Points& points, ClaimVerdict& c) {
  c.rule =
      "against all tuned contestants of other families than its own: reproduced if fast projection "
      "takes less time than each at every size (95 % interval of the ratio above 1), changed if at "
      "the largest but not at all, not reproduced if not at the largest; undecided if an interval "
      "that this hangs on holds 1";
  const Curve fast = points.best("drape", "resolution", fast_projection.name);
  if (fast.size() < 2) return;
  std::string told;
  std::vector<Answer> sizes;
  for (const auto& [vertices, point] : fast) {
    std::vector<Answer> here;
    std::string rival;
    Ratio closest;
    for (const Role& one : points.ranked("drape", "resolution")) {
      if (points.same_family(one.name, fast_projection.name)) continue;
      const auto other = at(points.best("drape", "resolution", one.name), vertices);
      if (!other) continue;
      const Ratio slower = ratio(*other, point);
      here.push_back(above(slower, 1));
      if (rival.empty() || slower.value < closest.value) {
        closest = slower;
        rival = one.name;
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
  if (sizes.empty()) return;
  cite(c, fast);
  c.measured = told;
  const Answer all = all_of(sizes), largest = sizes.back();
  c.verdict = largest == Answer::yes && all == Answer::no ? changed
              : largest == Answer::no                     ? not_reproduced
                                                          : verdict_of(all);
  if (largest == Answer::open) c.verdict = undecided;
}

}  // namespace harness::claims
