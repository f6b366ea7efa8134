// Two results point by point: what has become slower, what fails now. Times must differ by a rank
// test and two ratios, as in rustc-perf and asv.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace harness {

// ---- What a comparison lets pass: configs/gate.json, schema configs/gate.schema.json ----

enum class CounterRule {
  exact,   // any difference fails, even less work: the base must then be renewed
  rise,    // only more work fails
  inform,  // differences are reported, and nothing fails
};

struct Gate {
  bool times = true;  // whether times count
  // A time has changed if all three agree.
  double significance = 0.05;  // one-sided Mann-Whitney p below this
  double median_ratio = 1.05, minimum_ratio = 1.03;
  CounterRule counter_rule = CounterRule::exact;
  std::vector<std::string> counters;  // names of `work` in a result file; all of them if empty
  // Largest permitted ratios of new to base; errors that are not listed do not count.
  std::map<std::string, double> errors{
      {"max_strain", 1.001}, {"trajectory", 1.01}, {"energy_drift", 1.01}};
  double error_floor = 1e-9;  // an error below this is rounding
};

// Both throw UsageError, naming file, key and value, for anything that is not a gate.
Gate read_gate(const std::string& path);
Gate parse_gate(const std::string& text, const std::string& path);

// ---- What is compared of a result ----

struct ComparedPoint {
  std::string sweep = {}, id = {}, status = {}, detail = {};
  std::string spec = {};  // a hash of what is run: parameters, settings, seed
  bool searched = false;  // which steps were tried depended on times
  bool best = false;
  nlohmann::json counters = {};               // by name
  std::map<std::string, double> errors = {};  // those of Gate::errors that are known
  std::vector<double> samples = {};           // wall seconds per simulated second
  std::string fingerprint = {};               // of what computed the counters; "": not known

  bool ok() const { return status == "ok"; }
  std::string key() const { return sweep + " " + id; }
  std::string search() const { return key().substr(0, key().rfind("/h:")); }  // all but the step
};

struct ComparedResult {
  std::string path;                   // of the first file
  nlohmann::json context;             // with the sweeps of all files
  std::vector<std::string> commands;  // that made them
  bool baseline = false, complete = true;
  std::vector<ComparedPoint> points;
};

// Result files of sweeps, or a baseline. Several files of one build and machine are one result.
// Throws UsageError, naming the file, for anything else.
ComparedResult read_compared(const std::vector<std::string>& paths);
ComparedPoint compared_point(const nlohmann::json& point);  // of a result file or a baseline

// A result without times, for a repository (schema inextensible-baseline/1).
nlohmann::ordered_json baseline_document(const ComparedResult& result);

// ---- The comparison ----

std::string per_cent(double ratio);  // how far from 1: "+5 %", "-3.1 %"

// In the order of tables.
enum class Change {
  newly_failing,  // ran in the base
  missing,        // of the base's points
  slower,         // in time, or more work; a regression
  changed,        // less work under the rule "exact", or a larger error; a regression
  ambiguous,      // cannot be decided
  fixed,
  faster,
  added,
  same,
};
inline constexpr std::array change_names{
    "NEWLY_FAILING", "MISSING", "SLOWER", "CHANGED", "AMBIGUOUS", "FIXED", "FASTER", "NEW", "SAME"};
constexpr const char* to_string(Change change) { return change_names[static_cast<int>(change)]; }
constexpr bool is_failure(Change change) { return change <= Change::missing; }
constexpr bool is_regression(Change change) {
  return change == Change::slower || change == Change::changed;
}

struct PointChange {
  Change change = Change::same;
  std::string sweep, id;
  std::vector<std::string> reasons = {};  // one line each
  bool too_few = false;                   // too few runs is the only reason
  bool undecided = false;                 // a best point with too few runs or too noisy a machine

  std::string text() const;  // the reasons in one line
};

struct TimeChange {
  Change change = Change::same;  // same, faster, slower or ambiguous
  std::string reason = {};       // "" if same
  bool too_few = false;          // ambiguous: too few samples
};

// Faster and slower are judged alike, from the faster side. noise: |log(ratio of times)| up to
// which a difference does not count.
TimeChange compare_times(const std::vector<double>& base, const std::vector<double>& next,
                         const Gate& gate, double noise = 0);

struct Comparability {
  std::string no_counters, no_times;  // why not; "" if they can
  double noise = 0;                   // of A/A pairs: smaller |log(ratio)|s of times do not count
  double drift = 0;  // of the machine's own speed, beyond that: smaller ones are undecided
  bool counters() const { return no_counters.empty(); }
  bool times() const { return no_times.empty(); }
};
Comparability comparability(const ComparedResult& base, const ComparedResult& next,
                            const Gate& gate);

PointChange compare_point(const ComparedPoint& base, const ComparedPoint& next, const Gate& gate,
                          const Comparability& can);

struct Comparison {
  std::vector<PointChange> points;  // of the base in its order, then new ones
  std::vector<std::string> notes;   // what was not compared, and why

  std::size_t count(Change change) const {
    return std::ranges::count(points, change, &PointChange::change);
  }
  bool any(bool (*is)(Change)) const {
    return std::ranges::any_of(points, is, &PointChange::change);
  }
  bool undecided() const { return std::ranges::any_of(points, &PointChange::undecided); }
};

// Build, machine or scenes differ so much that a comparison would be meaningless.
struct NotComparable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

Comparison compare(const ComparedResult& base, const ComparedResult& next, const Gate& gate);

// ---- Two programs timed in interleaved pairs of processes, one point each, so that disturbances
// affect both ----

enum class Side { old_one, new_one };

struct PairedPoint {
  nlohmann::json spec;                    // what `bench point` reads, with the point's id
  int samples = 1;                        // runs in one process
  ComparedPoint before = {}, after = {};  // samples: one time per process

  ComparedPoint& said(Side side) { return side == Side::old_one ? before : after; }
};

// What `bench point` printed of one point, with the samples of all its runs.
using RunOne = std::function<ComparedPoint(Side, const PairedPoint&)>;

// `pairs` rounds over all points; the sides take turns in coming first (ABBA). A point that has
// failed on either side is left alone from then on. Then points whose times have changed are timed
// again, from scratch, in `confirming` pairs: only what is found both times counts. "Same" is said
// only where the 95 % interval of the times' ratio stays within what the gate lets pass.
Comparison compare_in_pairs(std::vector<PairedPoint> points, int pairs, int confirming,
                            const Gate& gate, const Comparability& can, const RunOne& run);

// A table of the points that are not SAME, notes, and the number of changes of each kind.
void print_comparison(std::ostream& out, const Comparison& comparison);

}  // namespace harness
