#include "harness/compare/comparison.h"

#include <deque>
#include <set>

#include "harness/base/statistics.h"
#include "harness/points/result_file.h"

namespace harness {

std::string per_cent(double ratio) {
  return (ratio < 1 ? "" : "+") + number_text(100 * (ratio - 1), 3) + " %";
}

namespace {

void note_counters(const ComparedPoint& base, const ComparedPoint& next, const Gate& gate,
                   PointChange& result) {
  bool rose = false, fell = false;
  for (const auto& [name, before] : base.counters.items()) {
    const double value = before, other = next.counters.value(name, value);
    const bool counts = gate.counters.empty() || std::ranges::count(gate.counters, name) > 0;
    if (other == value || !counts) continue;
    (other > value ? rose : fell) = true;
    std::string reason = name + " " + number_text(value, 15) + " -> " + number_text(other, 15);
    if (value > 0) reason += " (" + per_cent(other / value) + ")";
    result.reasons.push_back(reason);
  }
  if (gate.counter_rule == CounterRule::inform) return;
  if (rose)
    result.change = Change::slower;
  else if (fell)
    result.change = gate.counter_rule == CounterRule::exact ? Change::changed : Change::faster;
}

void note_errors(const ComparedPoint& base, const ComparedPoint& next, const Gate& gate,
                 PointChange& result) {
  for (const auto& [name, ratio] : gate.errors) {
    const auto before = base.errors.find(name), after = next.errors.find(name);
    if (before == base.errors.end() || after == next.errors.end()) continue;
    if (after->second <= std::max(gate.error_floor, before->second * ratio)) continue;
    result.reasons.push_back(name + " " + number_text(before->second) + " -> " +
                             number_text(after->second));
    if (result.change != Change::slower) result.change = Change::changed;
  }
}

void note_times(const ComparedPoint& base, const ComparedPoint& next, const Gate& gate,
                const Comparability& can, PointChange& result) {
  TimeChange times = compare_times(base.samples, next.samples, gate, can.noise);
  if (times.change == Change::same) return;
  const double by = std::abs(std::log(time_of(next.samples) / time_of(base.samples)));
  const bool drifted =
      times.change != Change::ambiguous && can.drift > 0 && by <= can.noise + can.drift;
  if (drifted)
    times = {Change::ambiguous, times.reason + ": the machine's own speed varied by as much"};
  result.reasons.push_back(times.reason);
  result.too_few = times.too_few && result.reasons.size() == 1;
  result.undecided = (times.too_few || drifted) && base.best;
  if (times.change == Change::slower || !is_regression(result.change)) result.change = times.change;
}

// Both failed: how far a run got before a time-out depends on the machine.
void note_failures(const ComparedPoint& base, const ComparedPoint& next, const Gate& gate,
                   const Comparability& can, PointChange& result) {
  const std::set<std::string> by_machine{"timeout", "skipped", "crashed", "out_of_memory"};
  if (by_machine.contains(base.status) || by_machine.contains(next.status)) return;
  if (base.status != next.status) {
    result.change = Change::ambiguous;
    result.reasons.push_back("fails in another way: " + base.status + " -> " + next.status);
  } else if (can.counters()) {
    note_counters(base, next, gate, result);
  }
}

// Which steps a search tried depends on times: one that only one result tried, or gave up because a
// better one was known, is not evidence.
struct Tried {
  explicit Tried(const ComparedResult& result) {
    for (const ComparedPoint& point : result.points) best[point.search()] |= point.best;
  }
  bool covers(const ComparedPoint& point) const {
    return point.searched && best.contains(point.search());
  }
  bool gave_up(const ComparedPoint& point) const {
    return covers(point) && point.status == "timeout" && best.at(point.search());
  }

  std::map<std::string, bool> best;  // searches, and whether a step of each was best
};

constexpr double same_speed = 0.05;     // of two machines: |log(ratio)| of the fixed kernel's times
constexpr double unknown_spread = 0.5;  // of a noisy file that does not say

// How much the machine's own speed varied, within each sweep and between them, by the times of the
// fixed kernel that sweeps run in between; without it the ratio is not a number.
double drift_between(const json& base, const json& next) {
  double drift = 0, log_seconds[2] = {std::nan(""), std::nan("")};
  for (const int i : {0, 1}) {
    const json kernel = (i == 0 ? base : next).value("sentinel", json::object());
    if (kernel.value("noisy", false))
      drift = std::max(drift, std::log1p(kernel.value("spread", unknown_spread)));
    if (kernel.contains("seconds"))
      log_seconds[i] = std::log(quantile(kernel.at("seconds").get<std::vector<double>>(), 0.5));
  }
  const double ratio = std::abs(log_seconds[1] - log_seconds[0]);
  return ratio > same_speed ? std::max(drift, ratio) : drift;
}

std::vector<std::string> notes_of(const ComparedResult& base, const ComparedResult& next,
                                  const Comparability& can) {
  if (!can.counters() && !can.times())
    throw NotComparable("neither counters (" + can.no_counters + ") nor times (" + can.no_times +
                        ") of '" + base.path + "' and '" + next.path + "' compare");
  std::vector<std::string> notes;
  if (!can.counters()) notes.push_back("counters not compared: " + can.no_counters);
  if (!can.times()) notes.push_back("times not compared: " + can.no_times);
  if (can.times() && can.drift > 0)
    notes.push_back("the machine's own speed varied by " + per_cent(std::exp(can.drift)) +
                    ": times that differ by less are undecided");
  if (!next.complete) notes.push_back("'" + next.path + "' comes from an interrupted run");
  return notes;
}

// Points of one key (two sweeps of one scene in a suite) pair up in their order; null: a point is
// in one result only.
std::vector<std::pair<const ComparedPoint*, const ComparedPoint*>> paired(
    const ComparedResult& base, const ComparedResult& next) {
  std::vector<std::pair<const ComparedPoint*, const ComparedPoint*>> pairs;
  std::map<std::string, std::deque<std::size_t>> alone;
  for (const ComparedPoint& point : base.points) {
    alone[point.key()].push_back(pairs.size());
    pairs.emplace_back(&point, nullptr);
  }
  for (const ComparedPoint& point : next.points) {
    auto& same_key = alone[point.key()];
    if (same_key.empty()) {
      pairs.emplace_back(nullptr, &point);
    } else {
      pairs[same_key.front()].second = &point;
      same_key.pop_front();
    }
  }
  return pairs;
}

}  // namespace

std::string PointChange::text() const {
  std::string text;
  for (const std::string& reason : reasons) append(text, reason, "; ");
  return text;
}

TimeChange compare_times(const std::vector<double>& base, const std::vector<double>& next,
                         const Gate& gate, double noise) {
  if (base.empty() || next.empty()) return {};
  const double base_median = quantile(base, 0.5), next_median = quantile(next, 0.5);
  const bool slower = next_median > base_median;
  const auto& [slow, fast] = slower ? std::tie(next, base) : std::tie(base, next);
  const double fast_median = quantile(fast, 0.5), fast_minimum = time_of(fast);
  if (!(fast_minimum > 0)) return {};
  const bool median =
      quantile(slow, 0.5) / fast_median > std::max(gate.median_ratio, std::exp(noise));
  const bool minimum = time_of(slow) / fast_minimum > gate.minimum_ratio;
  if (!median && !minimum) return {};  // however sure: too small to matter
  const double p = mann_whitney_greater(slow, fast);
  const std::string measured = "time " + per_cent(time_of(next) / time_of(base)) + " (median " +
                               per_cent(next_median / base_median) + ", p = " + number_text(p, 2) +
                               ")";
  if (p < gate.significance) {
    if (median && minimum) return {slower ? Change::slower : Change::faster, measured};
    return {Change::ambiguous, measured + ": only the " + (median ? "median" : "minimum") +
                                   " differs by as much as counts"};
  }
  if (median && minimum && least_possible_p(base.size(), next.size()) >= gate.significance) {
    std::size_t enough = 1;
    while (least_possible_p(enough, enough) >= gate.significance) ++enough;
    return {Change::ambiguous,
            measured + ": " + std::to_string(base.size()) + " and " + std::to_string(next.size()) +
                " runs are too few to decide, it takes " + std::to_string(enough) + " each",
            true};
  }
  return {};
}

Comparability comparability(const ComparedResult& base, const ComparedResult& next,
                            const Gate& gate) {
  const auto agree = [&](const char* key) {
    return base.context.value(key, json()) == next.context.value(key, json());
  };
  const auto known = [](const ComparedResult& result) {
    return !result.context.value("counters_fingerprint", "").empty();
  };
  Comparability can;
  if (!agree(known(base) && known(next) ? "counters_fingerprint" : "fingerprint"))
    can.no_counters = "compiler, flags or libraries differ";
  if (!gate.times)
    can.no_times = "the gate does not count them";
  else if (base.baseline || next.baseline)
    can.no_times = "a baseline has none";
  else if (!base.context.value("timed", true) || !next.context.value("timed", true))
    can.no_times = "one of them was made with --untimed";
  else if (!agree("cpu_model") || !agree("num_cpus"))
    can.no_times = "the machines differ";
  can.drift = drift_between(base.context, next.context);
  for (const ComparedResult* result : {&base, &next})
    if (const auto pair = noise_of(result->context)) can.noise = std::max(can.noise, pair->q95);
  return can;
}

PointChange compare_point(const ComparedPoint& base, const ComparedPoint& next, const Gate& gate,
                          const Comparability& can) {
  PointChange result{Change::same, base.sweep, base.id};
  if (base.ok() && !next.ok()) {
    result.change = Change::newly_failing;
    result.reasons.push_back(next.status + (next.detail.empty() ? "" : ": " + next.detail));
  } else if (!base.ok() && next.ok()) {
    result.change = Change::fixed;
    result.reasons.push_back("was " + base.status);
  } else if (!base.ok()) {
    note_failures(base, next, gate, can, result);
  } else {
    if (can.counters()) note_counters(base, next, gate, result);
    note_errors(base, next, gate, result);
    if (can.times()) note_times(base, next, gate, can, result);
  }
  return result;
}

Comparison compare(const ComparedResult& base, const ComparedResult& next, const Gate& gate) {
  const Comparability can = comparability(base, next, gate);
  Comparison comparison{{}, notes_of(base, next, can)};
  const Tried tried_before(base), tried(next);
  std::size_t untried = 0, matched = 0;
  for (const auto& [before, after] : paired(base, next)) {
    const ComparedPoint& point = before ? *before : *after;
    const bool both = before && after;
    matched += both;
    if (both && before->spec != after->spec)
      throw NotComparable(
          point.id + " is not the same run in both: scene parameters, settings or seed differ");
    if (both ? tried_before.gave_up(*before) || tried.gave_up(*after)
             : (before ? tried : tried_before).covers(point)) {
      ++untried;
    } else if (both) {
      comparison.points.push_back(compare_point(*before, *after, gate, can));
    } else {
      comparison.points.push_back({before ? Change::missing : Change::added,
                                   point.sweep,
                                   point.id,
                                   {(before ? "was " : "") + point.status}});
    }
  }
  if (matched == 0)
    throw NotComparable("'" + base.path + "' and '" + next.path + "' have no point in common");
  if (untried > 0)
    comparison.notes.push_back(std::to_string(untried) +
                               " steps were tried, or run to the end, in only one of them: their "
                               "searches went different ways");
  return comparison;
}

// ---- Interleaved pairs ----

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
