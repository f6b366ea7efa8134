// The search for a method's best settings by one rule for all, dynamically dimensioned search
// (Tolson and Shoemaker, Water Resources Research 43, 2007): each trial moves some settings of the
// best set by a normal distance, all of them at first and one in the end, since settings interact
// (a relaxation and a target). Departure: distances shrink, for budgets of a few dozen trials.
// Knows no solver: what a set of settings costs, a function says.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "solvers/methods/backend.h"

namespace harness {

// A setting to be searched.
struct TunedNumber {
  std::string name;
  double initial = 0;
  inextensible::SearchRange range;
  bool whole = false;
};

// Those that a method's row marks as tunable, in its order; given ones are not touched.
std::vector<TunedNumber> tunable_numbers(const inextensible::Backend& backend,
                                         const inextensible::Settings& given = {});

using Values = std::vector<double>;  // one of each setting
// Seconds with these values, none if they fail. A value that lies above `hopeless` may be given up
// early, and is then none.
using TuneObjective = std::function<std::optional<double>(const Values&, double hopeless)>;

struct TuneRules {
  int budget = 40;           // evaluations at most, of all settings together
  double reach = 0.3;        // standard deviation of the first moves, over the range
  double least_gain = 0.05;  // all of it must be faster than the defaults by more than this
};

struct TuneOutcome {
  Values values;        // the initial ones if nothing is better by enough
  double gain = 1;      // seconds of the initial values over these, measured again
  int evaluations = 0;  // the first one included; at most the budget
};

// `guess`, if any, is tried right after the initial values. Throws what `seconds` throws.
TuneOutcome tune_values(const std::vector<TunedNumber>& numbers, const TuneObjective& seconds,
                        const TuneRules& rules = {}, const Values& guess = {});

// Where a value lies in its range, from 0 to 1, and back: by the logarithm of the distance to its
// bound where it has one; logarithmic where it spans a factor of ten, for counts too (of 1 +
// count).
double position_of(const TunedNumber& number, double value);
double value_at(const TunedNumber& number, double position);

}  // namespace harness
