#include "harness/run/tune.h"

#include <random>
#include <set>

#include "harness/run/step_search.h"

namespace harness {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();  // seconds of what fails
constexpr double give_up_trial_at = 1.5;                          // times the best seconds
constexpr double first_reach = 0.3;  // standard deviation of the first moves, over the range
constexpr double last_reach = 0.15;  // times the first
constexpr double least_gain = 0.05;  // the result must be faster than the defaults by more
constexpr std::uint64_t seed = 1;
constexpr int value_digits = 3;  // two more than the search can tell apart

double shift(const TunedNumber& number) {
  return number.whole && number.range.least < 1 ? 1 - number.range.least : 0;
}

bool logarithmic(const TunedNumber& number) {
  const double least = number.range.least + shift(number);
  return least > 0 && (number.range.largest + shift(number)) / least >= 10;
}

// A value on the scale on which the search is uniform.
double on_scale(const TunedNumber& number, double value) {
  if (number.range.bound) return -std::log(*number.range.bound - value);
  return logarithmic(number) ? std::log(value + shift(number)) : value;
}

using Random = std::mt19937_64;

// By a normal distance, reflected at an end of the range.
double moved(const TunedNumber& number, double value, double reach, Random& random) {
  double at = position_of(number, value) + std::normal_distribution<double>(0, reach)(random);
  if (at < 0) at = -at > 1 ? 0 : -at;
  if (at > 1) at = at > 2 ? 1 : 2 - at;
  return value_at(number, at);
}

constexpr double give_up_at = 2.5;  // times the time that is known at a place
constexpr double far_too_long = 4;  // times options.longest_run: no step of a short one takes it
constexpr int samples = 3;          // of the best steps

// Whether a run reached its end and its motion error, if known, is within the headline's.
bool counts(const PointResult& point) {
  return point.ok() && within_known_error(point.measures, headline_error);
}

struct Found {
  std::size_t rung = 0;  // of the best step
  double seconds = 0;    // s/s
};

// At one size and strain limit of the scene.
struct Tuner {
  const SweepSpec& scene;  // one size and limit
  const TuneOptions& options;
  const Runner& run_one;
  const std::vector<TunedNumber>& numbers;
  Values initial;              // where the search begins; it must improve on it
  std::vector<Values> others;  // tried too
  Search search = {};
  std::optional<double> stiffness = {};   // to begin calibrations from
  Found leader = {};                      // so far; where the next search begins
  std::map<Values, Found> measured = {};  // the last time

  // Nothing if no step counts with any settings. `guess` is tried first, and gets the values found.
  std::optional<TunedPlace> run(Values& guess) {
    begin(guess);
    if (!guess.empty()) others.insert(others.begin(), guess);
    if (leader.seconds >= 1e300) draw_start();
    if (leader.seconds >= 1e300) return {};
    const auto seconds = [this](const Values& values, double hopeless) {
      return evaluate(values, hopeless);
    };
    std::vector<TunedNumber> from = numbers;
    for (std::size_t i = 0; i < from.size(); ++i) from[i].initial = initial[i];
    const TuneOutcome outcome = tune_values(from, seconds, options.budget, others);
    const auto was = measured.find(initial), is = measured.find(outcome.values);
    if (was == measured.end() || is == measured.end()) return {};
    guess = outcome.values;
    const Found &before = was->second, &now = is->second;
    return TunedPlace{
        {search.base.resolution, search.base.strain_limit, settings_of(outcome.values)},
        outcome.evaluations,
        before.seconds,
        search.ladder[before.rung],
        now.seconds,
        search.ladder[now.rung]};
  }

  void take_size(int size) {
    Suite suite;
    suite.sweeps = {scene};
    suite.sweeps.front().resolutions = {size};
    search = plan(suite, {}).front();
    stiffness.reset();
    leader = {0, 1e300};
    measured.clear();
  }

  Settings settings_of(const Values& values) const {
    Settings settings;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (values[i] != numbers[i].initial) settings[numbers[i].name] = values[i];
    return settings;
  }

  PointResult run_once(std::size_t rung, const Settings& settings, double most_seconds) {
    PointSpec what = search.base;
    what.step = search.ladder[rung];
    what.settings = settings;
    const double hopeless = std::max(0.05, most_seconds * duration());
    PointResult point = run_one(what, {.timeout = options.timeout,
                                       .hopeless = hopeless,
                                       .interrupted = options.interrupted,
                                       .stiffness_guess = stiffness});
    if (point.stiffness) stiffness = point.stiffness;
    return point;
  }

  void repeat(PointResult& point) const {
    add_sample(point, run_one, {.timeout = options.timeout, .interrupted = options.interrupted});
  }

  // Finds the best step with the initial settings, at a smaller size where it takes too long with
  // both these and `guess`: a default must not decide at which size a method is tuned.
  void begin(const Values& guess) {
    take_size(scene.resolutions.front());
    const std::vector<int> smaller_ones = smaller_sizes(scene.scene);
    find_best(far_too_long * options.longest_run);
    for (const int size : smaller_ones) {
      if (leader.seconds < 1e300 && takes_too_long() && !guess.empty())
        evaluate(guess, give_up_at * leader.seconds);
      if (!takes_too_long()) break;
      if (size >= search.base.resolution) continue;
      take_size(size);
      find_best(size == smaller_ones.back() ? 1e300 : far_too_long * options.longest_run);
    }
  }

  // Where no step counts initially: begins with the first other or drawn set for which one does.
  void draw_start() {
    std::mt19937_64 random{1};
    std::uniform_real_distribution<double> position(0, 1);
    const std::size_t tries = others.size() + static_cast<std::size_t>(options.budget);
    for (std::size_t t = 0; t < tries && leader.seconds >= 1e300; ++t) {
      for (std::size_t i = 0; i < initial.size(); ++i)
        initial[i] = t < others.size() ? others[t][i] : value_at(numbers[i], position(random));
      find_best(1e300);
    }
  }

  bool takes_too_long() const { return !(leader.seconds * duration() <= options.longest_run); }

  double duration() const { return search.base.scene_parameters.at("duration"); }

  void find_best(double most_seconds) {
    std::map<std::size_t, PointResult> known;
    double best = most_seconds / duration() / give_up_at;
    const auto run = [&](std::size_t rung, double) -> const PointResult& {
      const auto [at, fresh] = known.try_emplace(rung);
      if (fresh) at->second = run_once(rung, settings_of(initial), give_up_at * best);
      if (counts(at->second)) best = std::min(best, at->second.seconds());
      return at->second;
    };
    const auto again = [&](std::size_t rung) { repeat(known.at(rung)); };
    find_best_steps({search.ladder.size(), run, again, {headline_error}});
    for (const auto& [rung, point] : known)
      if (counts(point)) learn({rung, point.seconds()});
  }

  // Seconds of the best step with these settings; none above `hopeless`.
  std::optional<double> evaluate(const Values& values, double hopeless) {
    const Settings settings = settings_of(values);
    const bool in_race = hopeless < 1e300;
    const auto own = measured.find(values);
    auto [rung, fastest] =
        best_step(settings, own == measured.end() ? leader.rung : own->second.rung, in_race ? 1 : 2,
                  hopeless);
    // One run is enough to rule out slower settings.
    if (fastest.ok() && (!in_race || fastest.seconds() < leader.seconds))
      for (int i = 1; i < samples; ++i) repeat(fastest);
    const bool found = fastest.ok() && fastest.seconds() <= hopeless;
    options.tell(scene.scene + "/" + search.base.solver + " " + json(settings).dump() + ": " +
                 (found ? duration_text(fastest.seconds()) + "/s" : "too slow"));
    if (!found) return {};
    learn(measured[values] = {rung, fastest.seconds()});
    return fastest.seconds();
  }

  void learn(const Found& found) {
    if (found.seconds < leader.seconds) leader = found;
  }

  // The rung of the fastest step and its run, which is not ok if none counts: from `start` to both
  // sides, until `patience` steps in a row are not faster.
  std::pair<std::size_t, PointResult> best_step(const Settings& settings, std::size_t start,
                                                int patience, double hopeless) {
    std::pair<std::size_t, PointResult> best;
    const PointResult& fastest = best.second;
    const auto faster = [&](std::size_t rung) {
      PointResult point = run_once(rung, settings, fastest.ok() ? fastest.seconds() : hopeless);
      if (!counts(point) || (fastest.ok() && point.seconds() >= fastest.seconds())) return false;
      best = {rung, std::move(point)};
      return true;
    };
    faster(start);
    for (const int direction : {1, -1}) {
      int in_vain = 0;
      for (auto at = static_cast<int>(start) + direction;
           in_vain < patience && at >= 0 && at < static_cast<int>(search.ladder.size());
           at += direction)
        in_vain = faster(static_cast<std::size_t>(at)) ? 0 : in_vain + 1;
    }
    return best;
  }
};

Values values_of(const Settings& settings, const std::vector<TunedNumber>& numbers) {
  Values values;
  for (const TunedNumber& number : numbers) {
    const auto given = settings.find(number.name);
    values.push_back(given == settings.end() ? number.initial : std::get<double>(given->second));
  }
  return values;
}

}  // namespace

TuneOutcome tune_values(const std::vector<TunedNumber>& numbers, const TuneObjective& seconds,
                        int budget, const std::vector<Values>& guesses) {
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
  // The last comparison takes two evaluations.
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
  for (const Values& guess : guesses)
    if (left() > 0) try_out(guess);
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

std::vector<TunedNumber> tunable_numbers(const Backend& backend) {
  std::vector<TunedNumber> numbers;
  for (const auto& info : backend.settings) {
    if (!info.tunable) continue;
    numbers.push_back({info.name, std::get<double>(info.initial), *info.tunable, info.range.whole});
  }
  return numbers;
}

double position_of(const TunedNumber& number, double value) {
  const auto& [least, largest, bound] = number.range;
  const double low = on_scale(number, least), high = on_scale(number, largest);
  return (on_scale(number, std::clamp(value, least, largest)) - low) / (high - low);
}

double value_at(const TunedNumber& number, double position) {
  const auto& [least, largest, bound] = number.range;
  const double at = std::lerp(on_scale(number, least), on_scale(number, largest), position);
  if (bound) return std::clamp(*bound - rounded_to(std::exp(-at), value_digits), least, largest);
  const double value = logarithmic(number) ? std::exp(at) - shift(number) : at;
  if (number.whole) return std::clamp(std::round(value), std::ceil(least), std::floor(largest));
  return std::clamp(rounded_to(value, value_digits), least, largest);
}

TunedEntry tune_solver(const std::string& solver, const SweepSpec& scene, TuneOptions options,
                       const Runner& run, const TunedEntry* known,
                       const std::vector<Settings>& others) {
  const Backend& backend = *find_backend(solver);
  const std::vector<TunedNumber> numbers = tunable_numbers(backend);
  options.budget = std::min(options.budget, options.trials_each * static_cast<int>(numbers.size()));
  TunedEntry entry{.kind = find_scene(scene.scene)->kind(),
                   .solver = solver,
                   .budget = options.budget,
                   .places = {},
                   .rule = tuning_rule(scene, backend),
                   .context = {}};
  if (numbers.empty()) return entry;
  Contestant there{.name = solver, .solver = solver};
  if (known) there.settings_at = known->settings_at();
  std::vector<Values> tried;
  if (known) tried.push_back(values_of({}, numbers));
  for (const Settings& other : others) tried.push_back(values_of(other, numbers));
  Values guess;
  for (const int size : scene.resolutions)
    for (const double limit : scene.limits) {
      SweepSpec here = scene;
      here.contestants = {{solver, solver}};
      here.refine = false;
      here.resolutions = {size};
      here.limits = {limit};
      if (auto place = Tuner{here, options, run, numbers,
                             values_of(there.settings_for(size, limit), numbers), tried}
                           .run(guess))
        entry.places.push_back(std::move(*place));
    }
  return entry;
}

}  // namespace harness
