#include "harness/compare/pairs.h"

#include <algorithm>
#include <cmath>

#include "harness/base/statistics.h"
#include "harness/base/text.h"

namespace harness {
namespace {

bool has_failed(const ComparedPoint& side) { return !side.status.empty() && !side.ok(); }

bool failed(const PairedPoint& point) {
  return has_failed(point.before) || has_failed(point.after);
}

void run_side(Side side, PairedPoint& point, const RunOne& run) {
  const nlohmann::json printed = run(side, point);
  ComparedPoint& said = side == Side::old_one ? point.before : point.after;
  ComparedPoint now = compared_point(printed);
  // The first process speaks for the point, unless a later one fails.
  std::vector<double> times = std::move(said.samples);
  if (said.status.empty() || !now.ok()) said = now;
  if (now.ok()) times.push_back(process_time(printed));
  said.samples = std::move(times);
}

std::string change_text(double ratio) {
  return (ratio < 1 ? "" : "+") + number_text(std::round(100 * (ratio - 1))) + " %";
}

// "Same" is a statement: it takes runs on both sides, and times that exclude a change as large as
// the gate counts.
PointChange without_false_same(PointChange result, const PairedPoint& point, const Gate& gate) {
  const auto cannot_tell = [&result](const std::string& why) {
    result.change = Change::ambiguous;
    result.undecided = true;
    result.reasons.push_back("cannot tell: " + why);
  };
  if (has_failed(point.before) && has_failed(point.after)) {
    cannot_tell("fails on both sides: " + point.before.status + ", " + point.before.detail);
    return result;
  }
  if (failed(point) || (result.change != Change::same && result.change != Change::ambiguous))
    return result;
  const Ratio ratio = ratio_of_times(point.after.samples, point.before.samples);
  if (ratio.low < 1 / gate.median_ratio || ratio.high > gate.median_ratio)
    cannot_tell("the time may have changed by anything from " + change_text(ratio.low) + " to " +
                change_text(ratio.high));
  return result;
}

Change timing(const PairedPoint& point, const Gate& gate) {
  return compare_times(point.before.samples, point.after.samples, gate).change;
}

// After the second look at a time that was flagged as `first`.
PointChange judge_again(const PairedPoint& point, Change first, const Gate& gate,
                        const Comparability& can) {
  if (failed(point) || timing(point, gate) == first)
    return compare_point(point.before, point.after, gate, can);
  Comparability all_but_times = can;
  all_but_times.no_times = "not confirmed";
  PointChange result = compare_point(point.before, point.after, gate, all_but_times);
  const auto pairs = std::to_string(point.before.samples.size());
  result.reasons.push_back(std::string("time ") + to_string(first) +
                           " at first, but not in another " + pairs + " pairs");
  if (result.change == Change::same) result.change = Change::ambiguous;
  return result;
}

}  // namespace

double process_time(const nlohmann::json& printed) {
  return printed.at("seconds_per_simulated_second").at("min").get<double>();
}

int samples_for(double seconds, double least) {
  constexpr double most = 1000;
  return static_cast<int>(std::clamp(std::ceil(least / std::max(seconds, 1e-9)), 1.0, most));
}

void run_pairs(const std::vector<PairedPoint*>& points, int pairs, const RunOne& run) {
  for (int pair = 0; pair < pairs; ++pair) {
    const bool old_first = pair % 2 == 0;
    for (PairedPoint* point : points) {
      for (const Side side :
           {old_first ? Side::old_one : Side::new_one, old_first ? Side::new_one : Side::old_one}) {
        const ComparedPoint& said = side == Side::old_one ? point->before : point->after;
        if (said.status.empty() || !failed(*point)) run_side(side, *point, run);
      }
    }
  }
}

Comparison compare_in_pairs(std::vector<PairedPoint> points, int pairs, int confirming,
                            const Gate& gate, const Comparability& can, const RunOne& run) {
  struct Flagged {
    PairedPoint* point;
    std::size_t place;
    Change first;
  };
  std::vector<PairedPoint*> all, again;
  all.reserve(points.size());
  for (PairedPoint& point : points) all.push_back(&point);
  run_pairs(all, pairs, run);
  Comparison comparison;
  std::vector<Flagged> flagged;
  for (PairedPoint& point : points) {
    comparison.points.push_back(
        without_false_same(compare_point(point.before, point.after, gate, can), point, gate));
    const Change first = timing(point, gate);
    if (failed(point) || !can.times() || (first != Change::slower && first != Change::faster))
      continue;
    flagged.push_back({&point, comparison.points.size() - 1, first});
    again.push_back(&point);
    point.before.samples.clear();
    point.after.samples.clear();
  }
  run_pairs(again, confirming, run);
  for (const Flagged& f : flagged)
    comparison.points[f.place] =
        without_false_same(judge_again(*f.point, f.first, gate, can), *f.point, gate);
  return comparison;
}

}  // namespace harness
