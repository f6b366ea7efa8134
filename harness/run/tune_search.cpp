#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "harness/run/tune.h"

namespace harness {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();  // seconds of what fails
constexpr double give_up_trial_at = 1.5;                          // times the best seconds
constexpr double first_reach = 0.3;  // standard deviation of the first moves, over the range
constexpr double last_reach = 0.15;  // times the first
constexpr double least_gain = 0.05;  // all of it must be faster than the defaults by more than this
constexpr std::uint64_t seed = 1;

double shift(const TunedNumber& number) {
  return number.whole && number.range.least < 1 ? 1 - number.range.least : 0;
}

bool logarithmic(const TunedNumber& number) {
  const double least = number.range.least + shift(number);
  return least > 0 && (number.range.largest + shift(number)) / least >= 10;
}

// How many times farther the range's lower end is from its bound than the upper one.
double distance_ratio(const inextensible::SearchRange& range) {
  return (*range.bound - range.least) / (*range.bound - range.largest);
}

// To three digits: two more than the search can tell apart.
double rounded(double value) {
  const double digits = std::pow(10, 3 - std::ceil(std::log10(std::abs(value) + 1e-300)));
  return std::round(value * digits) / digits;
}

using Random = std::mt19937_64;

// By a normal distance, reflected at an end of the range.
double moved(const TunedNumber& number, double value, double reach, Random& random) {
  double at = position_of(number, value) + std::normal_distribution<double>(0, reach)(random);
  if (at < 0) at = -at > 1 ? 0 : -at;
  if (at > 1) at = at > 2 ? 1 : 2 - at;
  return value_at(number, at);
}

}  // namespace

TuneOutcome tune_values(const std::vector<TunedNumber>& numbers, const TuneObjective& seconds,
                        int budget, const Values& guess) {
  TuneOutcome outcome;
  for (const TunedNumber& n : numbers) outcome.values.push_back(n.initial);
  const Values initial = outcome.values;
  if (numbers.empty() || budget < 2) return outcome;
  std::set<Values> seen;
  const auto evaluate = [&](const Values& values, double hopeless) {
    ++outcome.evaluations;
    seen.insert(values);
    const auto found = seconds(values, hopeless);
    return found && std::isfinite(*found) ? *found : none;
  };
  // But for the last comparison, two evaluations.
  const auto left = [&] { return budget - 2 - outcome.evaluations; };
  double best = evaluate(initial, none);
  if (best == none) return outcome;
  const auto try_out = [&](const Values& values) {
    if (seen.contains(values)) return;
    const double found = evaluate(values, give_up_trial_at * best);
    if (found >= best) return;
    best = found;
    outcome.values = values;
  };
  if (!guess.empty() && left() > 0) try_out(guess);
  Random random{seed};
  const int steps = left();
  for (int step = 1; step <= steps; ++step) {
    const double reach = first_reach * std::pow(last_reach, static_cast<double>(step) / steps);
    const double probability = 1 - std::log(step) / std::log(std::max(2, steps));
    std::bernoulli_distribution moves(std::clamp(probability, 0.0, 1.0));
    std::uniform_int_distribution<std::size_t> any(0, numbers.size() - 1);
    Values values = outcome.values;
    // Rounding may lead back to what was tried: then draw again.
    for (int attempt = 0; attempt < 100 && seen.contains(values); ++attempt) {
      values = outcome.values;
      const std::size_t always = any(random);
      for (std::size_t i = 0; i < numbers.size(); ++i)
        if (i == always || moves(random)) values[i] = moved(numbers[i], values[i], reach, random);
    }
    try_out(values);
  }
  if (outcome.values == initial) return outcome;
  const double now = evaluate(outcome.values, none), was = evaluate(initial, none);
  const bool gained = now < none && was < none && was / now > 1 + least_gain;
  if (!gained) outcome.values = initial;
  return outcome;
}

std::vector<TunedNumber> tunable_numbers(const inextensible::Backend& backend) {
  std::vector<TunedNumber> numbers;
  for (const auto& info : backend.settings) {
    if (!info.tunable) continue;
    numbers.push_back({info.name, std::get<double>(info.initial), *info.tunable, info.range.whole});
  }
  return numbers;
}

double position_of(const TunedNumber& number, double value) {
  const auto& [least, largest, bound] = number.range;
  const double s = shift(number), inside = std::clamp(value, least, largest);
  if (bound)
    return std::log((*bound - least) / (*bound - inside)) / std::log(distance_ratio(number.range));
  if (!logarithmic(number)) return (inside - least) / (largest - least);
  return std::log((inside + s) / (least + s)) / std::log((largest + s) / (least + s));
}

double value_at(const TunedNumber& number, double position) {
  const auto& [least, largest, bound] = number.range;
  if (bound) {
    const double distance = (*bound - least) * std::pow(distance_ratio(number.range), -position);
    return std::clamp(*bound - rounded(distance), least, largest);
  }
  const double s = shift(number);
  const double value = logarithmic(number)
                           ? (least + s) * std::pow((largest + s) / (least + s), position) - s
                           : least + position * (largest - least);
  if (number.whole) return std::clamp(std::round(value), std::ceil(least), std::floor(largest));
  return std::clamp(rounded(value), least, largest);
}

}  // namespace harness
