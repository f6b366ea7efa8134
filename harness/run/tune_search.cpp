#include "harness/run/tune_search.h"

#include <gsl/gsl_qrng.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

namespace harness {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();  // seconds of what fails
constexpr double golden = 0.381966;       // of the wider side of a bracket, from the best point
constexpr double give_up_trial_at = 1.5;  // times the best seconds

double shift(const TunedNumber& number) {
  return number.whole && number.range.least < 1 ? 1 - number.range.least : 0;
}

bool logarithmic(const TunedNumber& number) {
  const double least = number.range.least + shift(number);
  return least > 0 && (number.range.largest + shift(number)) / least >= 10;
}

class CoordinateSearch {
 public:
  CoordinateSearch(const std::vector<TunedNumber>& numbers, const TuneObjective& seconds,
                   const TuneRules& rules)
      : numbers_(numbers), seconds_(seconds), rules_(rules) {}

  TuneOutcome run() {
    for (const TunedNumber& n : numbers_) outcome_.values.push_back(n.initial);
    const Values initial = outcome_.values;
    if (numbers_.empty() || rules_.budget < 2) return outcome_;
    best_ = evaluate(initial, none);
    if (best_ == none) return outcome_;
    spread();
    const int count = static_cast<int>(numbers_.size());
    const int visits = std::max(3, left() / (rules_.rounds * count));
    double half_width = 1;
    for (int round = 0; round < rules_.rounds; ++round) {
      const Values before = outcome_.values;
      for (std::size_t i = 0; i < numbers_.size(); ++i) visit(i, half_width, visits);
      // Nothing has moved: a narrower look at the same place is what the refinement was.
      if (outcome_.values == before) break;
      go_on_from(before);
      half_width = 1.0 / std::max(2, visits / 2);
    }
    if (outcome_.values == initial) return outcome_;
    const double now = evaluate_anew(outcome_.values), was = evaluate_anew(initial);
    if (now < none && was < none && was / now > 1 + rules_.least_gain) {
      outcome_.gain = was / now;
    } else {
      outcome_.values = initial;
    }
    return outcome_;
  }

 private:
  double evaluate(const Values& values, double hopeless) {
    ++outcome_.evaluations;
    const auto seconds = seconds_(values, hopeless);
    return seconds && std::isfinite(*seconds) ? *seconds : none;
  }
  double evaluate_anew(const Values& values) { return evaluate(values, none); }
  // But for the last comparison, two evaluations.
  int left() const { return rules_.budget - 2 - outcome_.evaluations; }

  // Sets of a low-discrepancy sequence (Niederreiter 1988) over the ranges of all settings.
  void spread() {
    const auto count = static_cast<unsigned>(numbers_.size());
    if (count > gsl_qrng_niederreiter_2->max_dimension) return;  // GSL would end the program
    const int sets = std::min(rules_.spread * static_cast<int>(count),
                              static_cast<int>(rules_.most_spread * rules_.budget));
    const std::unique_ptr<gsl_qrng, decltype(&gsl_qrng_free)> sequence(
        gsl_qrng_alloc(gsl_qrng_niederreiter_2, count), gsl_qrng_free);
    std::vector<double> positions(count);
    Values best = outcome_.values;
    double least = best_;
    for (int k = 0; k < sets && left() > 0; ++k) {
      gsl_qrng_get(sequence.get(), positions.data());
      Values values;
      for (std::size_t i = 0; i < count; ++i) values.push_back(value_at(numbers_[i], positions[i]));
      const double seconds = evaluate(values, give_up_trial_at * least);
      if (seconds >= least) continue;
      least = seconds;
      best = std::move(values);
    }
    take_if_better(best, least);
  }

  // Further along what a round has changed, as long as that helps.
  void go_on_from(const Values& before) {
    Values from = before;
    for (Values now = outcome_.values; now != from && left() > 0;) {
      Values further;
      for (std::size_t i = 0; i < numbers_.size(); ++i) {
        const double at = position_of(numbers_[i], now[i]);
        further.push_back(value_at(
            numbers_[i], std::clamp(2 * at - position_of(numbers_[i], from[i]), 0.0, 1.0)));
      }
      if (further == now) return;
      take_if_better(further, evaluate(further, give_up_trial_at * best_));
      from = now;
      now = outcome_.values;
    }
  }

  // One setting, the others as they are: points evenly over what is within half_width of the
  // present one, then golden sections of the wider side beside the best.
  void visit(std::size_t i, double half_width, int evaluations) {
    const TunedNumber& number = numbers_[i];
    const double here = position_of(number, outcome_.values[i]);
    std::map<double, double> known{{here, best_}};  // seconds by position
    const auto look = [&](double position) {
      Values values = outcome_.values;
      values[i] = value_at(number, position);
      const double rounded = position_of(number, values[i]);
      const auto near = known.lower_bound(rounded - 1e-6);
      if ((near != known.end() && near->first < rounded + 1e-6) || left() <= 0) return false;
      known[rounded] = evaluate(values, give_up_trial_at * best_);
      --evaluations;
      return true;
    };
    const double low = std::max(0.0, here - half_width), high = std::min(1.0, here + half_width);
    const int grid = evaluations - evaluations / 2;
    for (int k = 0; k < grid; ++k) look(low + (high - low) * (k + 0.5) / grid);
    while (evaluations > 0 && refine(known, low, high, look)) {
    }
    take_best(i, known);
  }

  // Whether there was anything left to look at.
  template <class Look>
  static bool refine(const std::map<double, double>& known, double low, double high,
                     const Look& look) {
    const auto best =
        std::min_element(known.begin(), known.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    const double at = best->first;
    const double left = best == known.begin() ? low : std::prev(best)->first;
    const double right = std::next(best) == known.end() ? high : std::next(best)->first;
    // An end of the range that has not been looked at is itself the next point.
    const double below = best == known.begin() ? left : at - golden * (at - left);
    const double above = std::next(best) == known.end() ? right : at + golden * (right - at);
    const bool up = right - at > at - left;
    return look(up ? above : below) || look(up ? below : above);
  }

  void take_best(std::size_t i, const std::map<double, double>& known) {
    const auto best =
        std::min_element(known.begin(), known.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    Values values = outcome_.values;
    values[i] = value_at(numbers_[i], best->first);
    take_if_better(values, best->second);
  }

  // The best of many looks is partly luck, so it is compared once more, in turn with the present.
  void take_if_better(const Values& values, double seconds) {
    if (!(best_ / seconds > 1 + rules_.least_gain) || left() < 2) return;
    const double now = evaluate_anew(values), was = evaluate_anew(outcome_.values);
    if (now == none || was == none || !(was / now > 1 + rules_.least_gain)) return;
    outcome_.values = values;
    best_ = now;
  }

  const std::vector<TunedNumber>& numbers_;
  const TuneObjective& seconds_;
  TuneRules rules_;
  TuneOutcome outcome_;
  double best_ = none;
};

}  // namespace

TuneOutcome tune_values(const std::vector<TunedNumber>& numbers, const TuneObjective& seconds,
                        const TuneRules& rules) {
  return CoordinateSearch(numbers, seconds, rules).run();
}

std::vector<TunedNumber> tunable_numbers(const inextensible::Backend& backend,
                                         const inextensible::Settings& given) {
  std::vector<TunedNumber> numbers;
  for (const auto& info : backend.settings) {
    if (!info.tunable || given.contains(info.name)) continue;
    numbers.push_back({info.name, std::get<double>(info.initial), *info.tunable, info.whole});
  }
  return numbers;
}

double position_of(const TunedNumber& number, double value) {
  const auto& [least, largest, open] = number.range;
  const double s = shift(number), inside = std::clamp(value, least, largest);
  if (!logarithmic(number)) return (inside - least) / (largest - least);
  return std::log((inside + s) / (least + s)) / std::log((largest + s) / (least + s));
}

double value_at(const TunedNumber& number, double position) {
  const auto& [least, largest, open] = number.range;
  const double s = shift(number);
  double value = logarithmic(number)
                     ? (least + s) * std::pow((largest + s) / (least + s), position) - s
                     : least + position * (largest - least);
  if (number.whole) return std::clamp(std::round(value), std::ceil(least), std::floor(largest));
  // Two digits more than the search can tell apart; the ends themselves stay in the range.
  const double digits = std::pow(10, 3 - std::ceil(std::log10(std::abs(value) + 1e-300)));
  value = std::round(value * digits) / digits;
  return std::clamp(value, least, largest);
}

}  // namespace harness
