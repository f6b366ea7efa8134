// C1 to C3: implicit springs against fast projection on the chain.
#include <string>
#include <utility>
#include <vector>

#include "harness/analysis/paper_methods.h"
#include "harness/claims/contests.h"
#include "harness/claims/ways.h"

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

}  // namespace harness::claims
