// Two results point by point: what has become slower, what fails now. The rule for times is that of
// rustc-perf and asv put together: a rank test and two ratios, all of which must agree.
#pragma once

#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/compare/baseline.h"
#include "harness/compare/gate.h"

namespace harness {

enum class Change {
  same,
  faster,
  slower,         // in time, or more work; a regression
  changed,        // less work under the rule "exact", or a larger error; a regression
  ambiguous,      // cannot be decided; no regression
  newly_failing,  // ran in the base
  fixed,
  missing,  // of the base's points
  added,    // written NEW
};
const char* to_string(Change change);  // "SAME", ...
bool is_regression(Change change);
bool is_failure(Change change);

struct PointChange {
  Change change = Change::same;
  std::string sweep, id;
  std::vector<std::string> reasons;  // one line each, for people
  bool too_few = false;              // nothing to say but that times had too few runs
  bool undecided = false;            // too few runs, or too unquiet a machine, for a best point

  std::string text() const;  // the reasons in one line
};

struct TimeChange {
  Change change = Change::same;  // same, faster, slower or ambiguous
  std::string reason;            // "" if same
  bool too_few = false;          // ambiguous: too few samples
};

// Samples of the same unit. Faster and slower are judged alike, from the faster side.
// noise: |log(ratio of times)| up to which a difference is none.
TimeChange compare_times(const std::vector<double>& base, const std::vector<double>& next,
                         const Gate& gate, double noise = 0);

// What of two results can be compared at all.
struct Comparability {
  std::string no_counters, no_times;  // why not; "" if they can
  double noise = 0;                   // of A/A pairs: |log(ratio)|s of times below it are none
  // What the machine's own speed varied by, |log(ratio)|, beyond that: smaller ones are undecided.
  double drift = 0;
  bool counters() const { return no_counters.empty(); }
  bool times() const { return no_times.empty(); }
};
Comparability comparability(const ComparedResult& base, const ComparedResult& next,
                            const Gate& gate);

// One point in both. Times are left out unless `can.times()`, counters unless `can.counters()`.
PointChange compare_point(const ComparedPoint& base, const ComparedPoint& next, const Gate& gate,
                          const Comparability& can);

struct Comparison {
  std::vector<PointChange> points;  // of the base in its order, then new ones
  std::vector<std::string> notes;   // what was not compared, and why

  std::size_t count(Change change) const;
  bool any(bool (*is)(Change)) const;
  bool undecided() const;  // of a best point
};

// Build, machine or scenes differ so much that no comparison would mean anything.
class NotComparable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

Comparison compare(const ComparedResult& base, const ComparedResult& next, const Gate& gate);

// A table of the points that are not SAME, the notes, and how many there are of each kind of
// change.
void print_comparison(std::ostream& out, const Comparison& comparison);

// JUnit XML: one test case a point; regressions and failures are its failures. name: the suite's.
std::string junit_xml(const Comparison& comparison, const std::string& name);

// The same table for a pull request or a job summary. title: its heading.
std::string markdown_table(const Comparison& comparison, const std::string& title);

}  // namespace harness
