#include "harness/base/statistics.h"
#include "harness/compare/comparison.h"

namespace harness {
namespace {

bool has_failed(const ComparedPoint& side) { return !side.status.empty() && !side.ok(); }

bool failed(const PairedPoint& point) {
  return has_failed(point.before) || has_failed(point.after);
}

void run_side(Side side, PairedPoint& point, const RunOne& run) {
  ComparedPoint& said = point.said(side);
  if (!said.status.empty() && failed(point)) return;
  ComparedPoint now = run(side, point);
  // The first process speaks for the point, unless a later one fails. A process's time is the least
  // of its runs: interruptions only ever add, and what differs from process to process (where its
  // memory lies) is in every one of its runs.
  std::vector<double> times = std::move(said.samples);
  if (now.ok()) times.push_back(time_of(now.samples));
  if (said.status.empty() || !now.ok()) said = std::move(now);
  said.samples = std::move(times);
}

void run_pairs(const std::vector<PairedPoint*>& points, int pairs, const RunOne& run) {
  for (int pair = 0; pair < pairs; ++pair)
    for (PairedPoint* point : points) {
      run_side(pair % 2 == 0 ? Side::old_one : Side::new_one, *point, run);
      run_side(pair % 2 == 0 ? Side::new_one : Side::old_one, *point, run);
    }
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
  } else if (!failed(point) &&
             (result.change == Change::same || result.change == Change::ambiguous)) {
    const Ratio ratio = ratio_of_times(point.after.samples, point.before.samples);
    if (ratio.low < 1 / gate.median_ratio || ratio.high > gate.median_ratio)
      cannot_tell("the time may have changed by anything from " + per_cent(ratio.low) + " to " +
                  per_cent(ratio.high));
  }
  return result;
}

Change timing(const PairedPoint& point, const Gate& gate) {
  return compare_times(point.before.samples, point.after.samples, gate).change;
}

// After the second look at a time that was flagged as `first`.
PointChange judge_again(const PairedPoint& point, Change first, const Gate& gate,
                        Comparability can) {
  if (failed(point) || timing(point, gate) == first)
    return compare_point(point.before, point.after, gate, can);
  can.no_times = "not confirmed";
  PointChange result = compare_point(point.before, point.after, gate, can);
  result.reasons.push_back(std::string("time ") + to_string(first) +
                           " at first, but not in another " +
                           std::to_string(point.before.samples.size()) + " pairs");
  if (result.change == Change::same) result.change = Change::ambiguous;
  return result;
}

}  // namespace

Comparison compare_in_pairs(std::vector<PairedPoint> points, int pairs, int confirming,
                            const Gate& gate, const Comparability& can, const RunOne& run) {
  std::vector<PairedPoint*> all, again;
  for (PairedPoint& point : points) all.push_back(&point);
  run_pairs(all, pairs, run);
  Comparison comparison;
  std::vector<Change> first;
  for (PairedPoint& point : points) {
    comparison.points.push_back(
        without_false_same(compare_point(point.before, point.after, gate, can), point, gate));
    const Change change = timing(point, gate);
    const bool flagged =
        !failed(point) && can.times() && (change == Change::slower || change == Change::faster);
    first.push_back(flagged ? change : Change::same);
    if (!flagged) continue;
    again.push_back(&point);
    point.before.samples.clear();
    point.after.samples.clear();
  }
  run_pairs(again, confirming, run);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (first[i] != Change::same)
      comparison.points[i] =
          without_false_same(judge_again(points[i], first[i], gate, can), points[i], gate);
  return comparison;
}

}  // namespace harness
