// C1 to C3: implicit springs against fast projection on the chain, each at equal strain and at
// equal error.
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "harness/analysis/paper_methods.h"
#include "harness/claims/contests.h"

namespace harness::claims {
namespace {

constexpr double one_percent = 0.01;
constexpr double paper_chain = 80;  // vertices

struct Way {
  std::string words;
  Curve springs, fast;
};

Way at_equal_strain(const Points& points, const std::string& sweep, std::string words) {
  return {std::move(words), points.best("chain", sweep, implicit_springs.name),
          points.best("chain", sweep, fast_projection.name)};
}

Way at_equal_errors(const Points& points, std::string words) {
  return {std::move(words), points.best_at_errors("chain", implicit_springs.name),
          points.best_at_errors("chain", fast_projection.name)};
}

// Collects what each way says; the claim's verdict is that of all ways that were measured.
class Ways {
 public:
  explicit Ways(ClaimVerdict& claim) : claim_(claim) {}

  void add(const Way& way, const std::string& verdict, const std::string& measured) {
    claim_.measured += (verdicts_.empty() ? "" : "; ") + way.words + ": " + verdict +
                       (measured.empty() ? "" : ", " + measured);
    verdicts_.push_back(verdict);
    if (verdict == not_measured) return;
    cite(claim_, way.springs);
    cite(claim_, way.fast);
  }
  ~Ways() { claim_.verdict = verdict_of_all(verdicts_); }

 private:
  ClaimVerdict& claim_;
  std::vector<std::string> verdicts_;
};

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
    ways.add(way, not_measured, "");
  } else {
    ways.add(way, verdict_of(fast_is_better(slope, 0)), told(way, slope, place));
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
      "the time of implicit springs over that of fast projection, against the strain limit (each "
      "at its best step) and against the error (step sweeps: least time within it): reproduced if "
      "the log-log slope lies below 0 with its whole 95 % interval in both, not reproduced if "
      "above 0 in both, changed if they differ, undecided if an interval holds 0; a way that was "
      "not measured does not count";
  Ways ways(c);
  judge_slopes(ways, at_equal_strain(points, "strain", "at equal strain"), below, percent);
  judge_slopes(ways, at_equal_errors(points, "at equal error"), below, percent);
}

void chain_time_over_resolution(const Points& points, ClaimVerdict& c) {
  c.rule =
      "the time of implicit springs over that of fast projection, against vertices, of best steps "
      "and of the fastest steps within an error (the smallest level that both reach at three sizes "
      "or more): reproduced if the log-log slope lies above "
      "0 with its whole 95 % interval in both, not reproduced if below 0 in both, changed if they "
      "differ, undecided if an interval holds 0; a way that was not measured does not count";
  Ways ways(c);
  judge_slopes(ways, at_equal_strain(points, "resolution", "at equal strain"), above, vertices);
  for (auto level = error_levels.rbegin(); level != error_levels.rend(); ++level) {
    Way way{"at equal error", points.best_at_error("chain", implicit_springs.name, *level),
            points.best_at_error("chain", fast_projection.name, *level)};
    const bool enough = slope_of_ratio(way.springs, way.fast).points >= 3;
    if (!enough && std::next(level) != error_levels.rend()) continue;
    if (enough) way.words = "at " + percent(*level) + " error";
    return judge_slopes(ways, way, above, vertices);
  }
}

void chain_speed(const Points& points, ClaimVerdict& c) {
  c.rule =
      "implicit springs' time over fast projection's at 1 % strain and at 1 % error: reproduced if "
      "its 95 % interval lies between 12.5 and 50, changed if between 1 and 12.5 or above 50, not "
      "reproduced if below 1, undecided if it holds one of these bounds; changed too if strain and "
      "error differ; a way that was not measured does not count";
  Ways ways(c);
  const auto judge = [&](const Way& way) {
    const auto springs = at(way.springs, one_percent), fast = at(way.fast, one_percent);
    if (!springs || !fast || springs->number("vertices") != paper_chain)
      return ways.add(way, not_measured, "");
    const Ratio slower = ratio(*springs, *fast);
    const auto inside = [&](double low, double high) {
      return slower.above(low) && slower.below(high);
    };
    const std::string verdict = inside(12.5, 50)                      ? reproduced
                                : inside(1, 12.5) || slower.above(50) ? changed
                                : slower.below(1)                     ? not_reproduced
                                                                      : undecided;
    ways.add({way.words, {{one_percent, *springs}}, {{one_percent, *fast}}}, verdict,
             "ratio " + text(slower) + ": implicit springs " + apart(*springs) +
                 ", fast projection " + apart(*fast));
  };
  judge(at_equal_strain(points, "strain", "at 1 % strain"));
  judge(at_equal_errors(points, "at 1 % error"));
  c.measured += "; the search for a stiffness is not charged";
}

}  // namespace harness::claims
