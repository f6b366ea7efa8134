// The search for a solver's settings (docs/measuring.md, "Tuning"): dynamically dimensioned search
// (Tolson and Shoemaker, Water Resources Research 43, 2007). Each trial moves some settings of the
// best set by a normal distance, all at first and one in the end, since settings interact.
// Departure: distances shrink, for budgets of a few dozen trials.
#pragma once

#include "harness/points/tuned.h"
#include "harness/run/sweep.h"

namespace harness {

struct TunedNumber {
  std::string name;
  double initial = 0;
  inextensible::SearchRange range;
  bool whole = false;
};

// The settings that a method's row marks as tunable, in its order.
std::vector<TunedNumber> tunable_numbers(const Backend& backend);

using Values = std::vector<double>;  // one of each setting
// Seconds with these values; none if they fail, or may be none if they take longer than `hopeless`.
using TuneObjective = std::function<std::optional<double>(const Values&, double hopeless)>;

struct TuneOutcome {
  Values values;        // the initial ones unless these are faster by 5 %
  int evaluations = 0;  // the first one included; at most the budget
};

// Guesses are tried right after the initial values. Throws what `seconds` throws.
TuneOutcome tune_values(const std::vector<TunedNumber>& numbers, const TuneObjective& seconds,
                        int budget, const std::vector<Values>& guesses = {});

// A value's position in its range, from 0 to 1, and back: by the logarithm of the distance to its
// bound if it has one; else logarithmic if the range (of counts: 1 + count) spans a factor of ten.
double position_of(const TunedNumber& number, double value);
double value_at(const TunedNumber& number, double position);

struct TuneOptions {
  int budget = 40;       // evaluations at most, of all settings together
  int trials_each = 10;  // at most this many of them for each setting
  double timeout = 10;   // s, of a run
  // A place gets a smaller size if a solver's best run takes longer than this, with its own
  // settings and with those found at the previous place.
  double longest_run = 0.25;  // s
  std::function<bool()> interrupted = nullptr;
  std::function<void(const std::string&)> tell = [](const std::string&) {};  // lines of progress
};

// Without `context`. A place where nothing is gained has no settings; one where no settings work is
// left out. known: settings of other places; each search begins with those of the nearest one and
// must improve on them. others: settings that are tried next, after the defaults; what the solver
// lacks of them does not count. Throws Interrupted.
TunedEntry tune_solver(const std::string& solver, const SweepSpec& scene, TuneOptions options,
                       const Runner& run, const TunedEntry* known = nullptr,
                       const std::vector<Settings>& others = {});

}  // namespace harness
