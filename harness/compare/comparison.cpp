#include "harness/compare/comparison.h"

#include <algorithm>
#include <array>
#include <iomanip>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/points/noise.h"

namespace harness {
namespace {

using nlohmann::json;

std::string per_cent(double ratio) {
  return (ratio < 1 ? "" : "+") + number_text(100 * (ratio - 1), 3) + " %";
}

// The least number of runs of each that can be significant at all.
std::size_t least_samples(double significance) {
  std::size_t n = 1;
  while (least_possible_p(n, n) >= significance) ++n;
  return n;
}

std::string field(const json& context, const char* key) { return context.value(key, ""); }

void note_counters(const ComparedPoint& base, const ComparedPoint& next, const Gate& gate,
                   PointChange& result) {
  bool rose = false, fell = false;
  const auto wanted = [&gate](const std::string& name) {
    return gate.counters.empty() ||
           std::find(gate.counters.begin(), gate.counters.end(), name) != gate.counters.end();
  };
  for (const auto& [name, value] : base.counters) {
    const auto other = next.counters.find(name);
    if (other == next.counters.end() || other->second == value || !wanted(name)) continue;
    (other->second > value ? rose : fell) = true;
    std::string reason =
        name + " " + number_text(value, 15) + " -> " + number_text(other->second, 15);
    if (value > 0) reason += " (" + per_cent(other->second / value) + ")";
    result.reasons.push_back(reason);
  }
  if (gate.counter_rule == CounterRule::inform) return;
  if (rose) {
    result.change = Change::slower;
  } else if (fell) {
    result.change = gate.counter_rule == CounterRule::exact ? Change::changed : Change::faster;
  }
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
  const bool settled = is_regression(result.change);
  result.too_few = times.too_few && result.reasons.size() == 1;
  result.undecided = (times.too_few || drifted) && base.best;
  if (times.change == Change::slower || !settled) result.change = times.change;
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

// Where the step was searched, which steps were tried depends on times: a step that only one result
// tried, or gave up because a better one was known, says nothing.
class Tried {
 public:
  explicit Tried(const ComparedResult& result) {
    for (const ComparedPoint& point : result.points) {
      searches_.insert(point.search());
      if (point.best) best_.insert(point.search());
    }
  }
  bool covers(const ComparedPoint& point) const {
    return point.searched && searches_.contains(point.search());
  }
  bool gave_up(const ComparedPoint& point) const {
    return point.searched && point.status == "timeout" && best_.contains(point.search());
  }

 private:
  std::set<std::string> searches_, best_;
};

// Points by key; two of one key (two sweeps of one scene in a suite) pair up in their order.
std::multimap<std::string, const ComparedPoint*> by_key(const ComparedResult& result) {
  std::multimap<std::string, const ComparedPoint*> points;
  for (const ComparedPoint& point : result.points) points.emplace(point.key(), &point);
  return points;
}

PointChange one_sided(Change change, const ComparedPoint& point, const std::string& reason) {
  return {change, point.sweep, point.id, {reason}};
}

void check_same_runs(const ComparedPoint& base, const ComparedPoint& next) {
  if (base.spec != next.spec)
    throw NotComparable(base.id +
                        " is not the same run in both: scene parameters, settings or seed differ");
}

}  // namespace

const char* to_string(Change change) {
  constexpr std::array names{"SAME",          "FASTER", "SLOWER",  "CHANGED", "AMBIGUOUS",
                             "NEWLY_FAILING", "FIXED",  "MISSING", "NEW"};
  return names[static_cast<std::size_t>(change)];
}

bool is_regression(Change change) { return change == Change::slower || change == Change::changed; }

bool is_failure(Change change) {
  return change == Change::newly_failing || change == Change::missing;
}

std::string PointChange::text() const {
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
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
    const std::string enough = std::to_string(least_samples(gate.significance));
    return {Change::ambiguous,
            measured + ": " + std::to_string(base.size()) + " and " + std::to_string(next.size()) +
                " runs are too few to decide, it takes " + enough + " each",
            true};
  }
  return {};
}

namespace {

constexpr double same_speed = 0.05;     // of two machines: |log(ratio)| of the fixed kernel's times
constexpr double unknown_spread = 0.5;  // of a noisy file that does not say

// Time of the kernel that sweeps run in between; not-a-number in files without it.
double kernel_seconds(const nlohmann::json& context) {
  const auto place = context.find("sentinel");
  if (place == context.end() || !place->contains("seconds")) return std::nan("");
  return quantile(place->at("seconds").get<std::vector<double>>(), 0.5);
}

// Two sweeps, one after the other, tell builds apart only by more than the machine's own speed
// varied: within each of them, and from one to the other.
double drift_between(const nlohmann::json& base, const nlohmann::json& next) {
  double drift = 0;
  for (const auto* context : {&base, &next}) {
    const auto place = context->find("sentinel");
    if (place != context->end() && place->value("noisy", false))
      drift = std::max(drift, std::log1p(place->value("spread", unknown_spread)));
  }
  const double ratio = std::abs(std::log(kernel_seconds(next) / kernel_seconds(base)));
  return ratio > same_speed ? std::max(drift, ratio) : drift;
}

double q95_of(const nlohmann::json& context) {
  const auto pair = noise_of(context);
  return pair ? pair->q95 : 0;
}

}  // namespace

Comparability comparability(const ComparedResult& base, const ComparedResult& next,
                            const Gate& gate) {
  Comparability can;
  const std::string fingerprint = field(base.context, "counters_fingerprint");
  const bool same_build =
      fingerprint.empty() || field(next.context, "counters_fingerprint").empty()
          ? field(base.context, "fingerprint") == field(next.context, "fingerprint")
          : fingerprint == field(next.context, "counters_fingerprint");
  if (!same_build) can.no_counters = "compiler, flags or libraries differ";
  if (!gate.times) {
    can.no_times = "the gate does not count them";
  } else if (base.baseline || next.baseline) {
    can.no_times = "a baseline has none";
  } else if (!base.context.value("timed", true) || !next.context.value("timed", true)) {
    can.no_times = "one of them was made with --untimed";
  } else if (field(base.context, "cpu_model") != field(next.context, "cpu_model") ||
             base.context.value("num_cpus", 0) != next.context.value("num_cpus", 0)) {
    can.no_times = "the machines differ";
  }
  can.drift = drift_between(base.context, next.context);
  can.noise = std::max(q95_of(base.context), q95_of(next.context));
  return can;
}

PointChange compare_point(const ComparedPoint& base, const ComparedPoint& next, const Gate& gate,
                          const Comparability& can) {
  PointChange result{Change::same, base.sweep, base.id, {}};
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

std::size_t Comparison::count(Change change) const {
  return std::count_if(points.begin(), points.end(),
                       [change](const PointChange& point) { return point.change == change; });
}

bool Comparison::any(bool (*is)(Change)) const {
  return std::any_of(points.begin(), points.end(),
                     [is](const PointChange& point) { return is(point.change); });
}

bool Comparison::undecided() const {
  return std::any_of(points.begin(), points.end(),
                     [](const PointChange& point) { return point.undecided; });
}

Comparison compare(const ComparedResult& base, const ComparedResult& next, const Gate& gate) {
  const Comparability can = comparability(base, next, gate);
  if (!can.counters() && !can.times())
    throw NotComparable("neither counters (" + can.no_counters + ") nor times (" + can.no_times +
                        ") of '" + base.path + "' and '" + next.path + "' compare");
  Comparison comparison;
  if (!can.counters()) comparison.notes.push_back("counters not compared: " + can.no_counters);
  if (!can.times()) comparison.notes.push_back("times not compared: " + can.no_times);
  if (can.times() && can.drift > 0)
    comparison.notes.push_back("the machine's own speed varied by " +
                               per_cent(std::exp(can.drift)) +
                               ": times that differ by less are undecided");
  if (!next.complete) comparison.notes.push_back("'" + next.path + "' is of an interrupted run");
  auto left = by_key(next);
  const Tried tried_before(base), tried(next);
  std::size_t untried = 0, matched = 0;
  for (const ComparedPoint& point : base.points) {
    const auto found = left.lower_bound(point.key());
    if (found == left.end() || found->first != point.key()) {
      if (tried.covers(point)) {
        ++untried;
      } else {
        comparison.points.push_back(one_sided(Change::missing, point, "was " + point.status));
      }
      continue;
    }
    const ComparedPoint& other = *found->second;
    left.erase(found);
    ++matched;
    check_same_runs(point, other);
    if (tried_before.gave_up(point) || tried.gave_up(other)) {
      ++untried;
    } else {
      comparison.points.push_back(compare_point(point, other, gate, can));
    }
  }
  if (matched == 0)
    throw NotComparable("'" + base.path + "' and '" + next.path + "' have no point in common");
  for (const ComparedPoint& point : next.points) {
    const auto [first, last] = left.equal_range(point.key());
    const auto found =
        std::find_if(first, last, [&point](const auto& entry) { return entry.second == &point; });
    if (found == last) continue;
    if (tried_before.covers(point)) {
      ++untried;
    } else {
      comparison.points.push_back(one_sided(Change::added, point, point.status));
    }
  }
  if (untried > 0)
    comparison.notes.push_back(std::to_string(untried) +
                               " steps were tried, or run to the end, in one of them only: their "
                               "searches took other ways");
  return comparison;
}

namespace {

// From what matters most; the table's order too.
constexpr std::array order{Change::newly_failing, Change::missing,   Change::slower,
                           Change::changed,       Change::ambiguous, Change::fixed,
                           Change::faster,        Change::added,     Change::same};

std::vector<const PointChange*> sorted_changes(const Comparison& comparison) {
  std::vector<const PointChange*> list;
  for (const Change change : order) {
    for (const PointChange& point : comparison.points) {
      // SAME with a reason: a difference that the gate only wants told.
      if (point.change == change && !point.too_few &&
          (change != Change::same || !point.reasons.empty()))
        list.push_back(&point);
    }
  }
  return list;
}

std::string counts(const Comparison& comparison) {
  std::string text = std::to_string(comparison.points.size()) + " points: ";
  std::string separator;
  for (const Change change : order) {
    if (const std::size_t n = comparison.count(change); n > 0) {
      text += separator + std::to_string(n) + " " + to_string(change);
      separator = ", ";
    }
  }
  return text;
}

// One line for all points that differ in time and have too few runs to say whether they really do.
std::vector<std::string> all_notes(const Comparison& comparison) {
  std::vector<std::string> notes = comparison.notes;
  const auto few = std::count_if(comparison.points.begin(), comparison.points.end(),
                                 [](const PointChange& point) { return point.too_few; });
  if (few > 0) {
    const auto example = std::find_if(comparison.points.begin(), comparison.points.end(),
                                      [](const PointChange& point) { return point.too_few; });
    notes.push_back(std::to_string(few) + " of the AMBIGUOUS have too few runs, for example " +
                    example->id + ": " + example->text());
  }
  return notes;
}

bool fails(Change change) { return is_failure(change) || is_regression(change); }

// Control characters have no place in XML 1.0, not even escaped.
std::string xml(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\n':
        result += "&#10;";
        break;
      default:
        result += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return result;
}

// Inside a cell: no line may end, no cell may end, and nothing is a tag.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '*' || c == '_' || c == '`' || c == '\\') result += '\\';
    if (c == '<') {
      result += "&lt;";
    } else if (c == '&') {
      result += "&amp;";
    } else {
      result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return result;
}

// "drape/icd/n:225/..." of sweep strain: class strain.drape.icd.
std::string class_name(const PointChange& point) {
  const auto scene = point.id.find('/'), solver = point.id.find('/', scene + 1);
  std::string name = point.sweep + "." + point.id.substr(0, solver);
  std::replace(name.begin(), name.end(), '/', '.');
  return name;
}

}  // namespace

void print_comparison(std::ostream& out, const Comparison& comparison) {
  const auto list = sorted_changes(comparison);
  std::size_t width = 0;
  for (const PointChange* point : list)
    width = std::max(width, point->sweep.size() + point->id.size() + 3);
  for (const PointChange* point : list) {
    out << std::left << std::setw(14) << to_string(point->change)
        << std::setw(static_cast<int>(width)) << point->sweep + " " + point->id << point->text()
        << '\n';
  }
  if (!list.empty()) out << '\n';
  for (const std::string& note : all_notes(comparison)) out << "note: " << note << '\n';
  out << counts(comparison) << std::endl;
}

std::string junit_xml(const Comparison& comparison, const std::string& name) {
  const auto failures = std::count_if(comparison.points.begin(), comparison.points.end(),
                                      [](const PointChange& point) { return fails(point.change); });
  std::ostringstream text;
  const std::string totals = " tests=\"" + std::to_string(comparison.points.size()) +
                             "\" failures=\"" + std::to_string(failures) + "\" errors=\"0\"";
  text << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" << totals
       << ">\n<testsuite name=\"" << xml(name) << "\"" << totals << ">\n";
  for (const PointChange& point : comparison.points) {
    text << "<testcase classname=\"" << xml(class_name(point)) << "\" name=\"" << xml(point.id)
         << "\"";
    const std::string change = to_string(point.change);
    if (fails(point.change)) {
      text << "><failure type=\"" << change << "\" message=\"" << xml(change + ": " + point.text())
           << "\"/></testcase>\n";
    } else if (point.change != Change::same || !point.reasons.empty()) {
      text << "><system-out>" << xml(change + ": " + point.text()) << "</system-out></testcase>\n";
    } else {
      text << "/>\n";
    }
  }
  text << "</testsuite>\n</testsuites>\n";
  return text.str();
}

std::string markdown_table(const Comparison& comparison, const std::string& title) {
  std::string text = "### " + cell(title) + "\n\n" + counts(comparison) + "\n";
  const auto list = sorted_changes(comparison);
  if (!list.empty()) text += "\n| change | sweep | point | what |\n|---|---|---|---|\n";
  for (const PointChange* point : list) {
    const std::string change = cell(to_string(point->change));
    text += "| " + (fails(point->change) ? "**" + change + "**" : change) + " | " +
            cell(point->sweep) + " | " + cell(point->id) + " | " + cell(point->text()) + " |\n";
  }
  for (const std::string& note : all_notes(comparison)) text += "\nNote: " + cell(note) + "\n";
  return text;
}

}  // namespace harness
