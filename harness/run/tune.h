// The search for a solver's settings, by the rule of docs/measuring.md ("Tuning"): dynamically
// dimensioned search (Tolson and Shoemaker, Water Resources Research 43, 2007). Each trial moves
// some settings of the best set by a normal distance, all of them at first and one in the end,
// since settings interact (a relaxation and a target). Departure: distances shrink, for budgets of
// a few dozen trials.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/points/suite.h"
#include "harness/points/tuned.h"
#include "harness/run/sweep.h"
#include "solvers/methods/backend.h"

namespace harness {

// A setting to be searched.
struct TunedNumber {
  std::string name;
  double initial = 0;
  inextensible::SearchRange range;
  bool whole = false;
};

// Those that a method's row marks as tunable, in its order.
std::vector<TunedNumber> tunable_numbers(const inextensible::Backend& backend);

using Values = std::vector<double>;  // one of each setting
// Seconds with these values, none if they fail. A value that lies above `hopeless` may be given up
// early, and is then none.
using TuneObjective = std::function<std::optional<double>(const Values&, double hopeless)>;

struct TuneOutcome {
  Values values;        // the initial ones unless these are faster by 5 %
  int evaluations = 0;  // the first one included; at most the budget
};

// `guess`, if any, is tried right after the initial values. Throws what `seconds` throws.
TuneOutcome tune_values(const std::vector<TunedNumber>& numbers, const TuneObjective& seconds,
                        int budget, const Values& guess = {});

// Where a value lies in its range, from 0 to 1, and back: by the logarithm of the distance to its
// bound where it has one; logarithmic where it spans a factor of ten, for counts too (of 1 +
// count).
double position_of(const TunedNumber& number, double value);
double value_at(const TunedNumber& number, double position);

struct TuneOptions {
  int budget = 40;       // evaluations at most, of all settings together
  int trials_each = 10;  // of these at most so many for each setting
  double timeout = 10;   // s, of a run
  // Where a solver's best run takes longer than this, as it is and with what was found at the place
  // before, the place is taken at a smaller size.
  double longest_run = 0.25;  // s
  std::function<bool()> interrupted = nullptr;
  std::function<void(const std::string&)> tell = [](const std::string&) {};  // lines of progress
};

// Without `context`. A place has no settings where nothing is gained, and is left out where the
// solver fails as it is. known: settings of other places; each search begins with those of the
// nearest one instead of the solver's own, and must better them. Throws Interrupted.
TunedEntry tune_solver(const std::string& solver, const SweepSpec& scene, TuneOptions options,
                       const Runner& run, const TunedEntry* known = nullptr);

}  // namespace harness
