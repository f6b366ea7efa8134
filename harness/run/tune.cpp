#include "harness/run/tune.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/base/text.h"
#include "harness/points/point_json.h"
#include "harness/run/step_search.h"

namespace harness {
namespace {

constexpr double give_up_at = 2.5;  // times the best time known at a limit
constexpr int samples = 3;          // of the best steps, whose medians count
constexpr double luck = 1.1;        // how far above its median one run may lie

// One size and strain limit of the scene, and what is known there.
struct Place {
  Search search;
  std::optional<double> stiffness = {};  // to begin calibrations from
  std::size_t best_rung = 0;             // of the best time so far; where the next search begins
  double best_seconds = 1e300;           // s/s
};

struct Found {
  std::size_t rung = 0;
  double seconds = 0;  // s/s
};

// Geometric.
double mean_of(const std::vector<PointResult>& points) {
  double sum = 0;
  for (const PointResult& point : points) sum += std::log(point.median_seconds());
  return std::exp(sum / static_cast<double>(points.size()));
}

class Tuner {
 public:
  Tuner(const std::string& solver, const SweepSpec& scene, const TuneOptions& options,
        const SweepRunners& runners)
      : options_(options), runners_(runners) {
    Suite suite;
    suite.sweeps = {scene};
    suite.sweeps[0].contestants = {{solver, solver}};
    for (Search& search : plan(suite, {})) places_.push_back({.search = std::move(search)});
    numbers_ = tunable_numbers(*inextensible::find_backend(solver));
    entry_.kind = find_scene(scene.scene)->kind();
    entry_.solver = solver;
    entry_.budget = options.rules.budget;
  }

  TunedEntry run() {
    if (numbers_.empty()) return entry_;
    begin();
    if (places_.empty()) return entry_;
    const auto seconds = [this](const Values& values, double hopeless) {
      return evaluate(values, hopeless);
    };
    const TuneOutcome outcome = tune_values(numbers_, seconds, options_.rules);
    entry_.gain = outcome.gain;
    entry_.evaluations = outcome.evaluations;
    entry_.settings = settings_of(outcome.values);
    const auto was = last_.find(initial()), is = last_.find(outcome.values);
    if (was == last_.end() || is == last_.end()) return entry_;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const auto step = [&](const Found& found) { return places_[i].search.ladder[found.rung]; };
      const Found &before = was->second[i], &now = is->second[i];
      const PointSpec& base = places_[i].search.base;
      entry_.places.push_back({base.resolution, base.strain_limit, before.seconds, step(before),
                               now.seconds, step(now)});
    }
    return entry_;
  }

 private:
  Values initial() const {
    Values values;
    for (const TunedNumber& number : numbers_) values.push_back(number.initial);
    return values;
  }

  inextensible::Settings settings_of(const Values& values) const {
    inextensible::Settings settings;
    for (std::size_t i = 0; i < numbers_.size(); ++i)
      if (values[i] != numbers_[i].initial) settings[numbers_[i].name] = values[i];
    return settings;
  }

  PointSpec spec(const Place& place, std::size_t rung, const inextensible::Settings& settings) {
    PointSpec spec = place.search.base;
    spec.step = place.search.ladder[rung];
    spec.settings = settings;
    return spec;
  }

  PointResult run_once(Place& place, std::size_t rung, const inextensible::Settings& settings,
                       double most_seconds) {
    const PointSpec what = spec(place, rung, settings);
    const double hopeless = std::max(0.05, most_seconds * what.scene_parameters.at("duration"));
    PointResult point = runners_.run(
        what, {options_.timeout, hopeless, options_.interrupted, nullptr}, place.stiffness);
    if (point.stiffness) place.stiffness = point.stiffness;
    return point;
  }

  // The whole ladder's best step with the settings that the solver has by itself; limits at which
  // it has none say nothing about others.
  void begin() {
    for (Place& place : places_) {
      std::map<std::size_t, PointResult> known;
      double best = 1e300;
      StepSearch steps(place.search.ladder.size(), [&](std::size_t rung) -> const PointResult& {
        const auto [at, fresh] = known.try_emplace(rung);
        if (fresh) at->second = run_once(place, rung, {}, give_up_at * best);
        if (at->second.ok()) best = std::min(best, at->second.median_seconds());
        return at->second;
      });
      const auto rung = steps.find(std::nullopt);
      if (!rung) continue;
      place.best_rung = *rung;
      place.best_seconds = known.at(*rung).median_seconds();
    }
    std::erase_if(places_, [](const Place& place) { return place.best_seconds >= 1e300; });
  }

  // Whether that is too much time at a place, in view of what it is without any settings.
  bool loses(std::size_t place, double seconds) const {
    const auto without = last_.find(initial());
    return without != last_.end() &&
           seconds > (1 + options_.most_loss) * without->second[place].seconds;
  }

  // Geometric mean over the places; none if one fails or loses too much, or the mean is bound to be
  // above `hopeless`.
  std::optional<double> evaluate(const Values& values, double hopeless) {
    const inextensible::Settings settings = settings_of(values);
    const bool in_race = hopeless < 1e300;
    std::vector<PointResult> fastest;
    std::vector<std::size_t> rungs;
    double log_rest = 0;
    for (const Place& place : places_) log_rest += std::log(0.5 * place.best_seconds);
    for (Place& place : places_) {
      PointResult point;
      const auto rung = best_step(place, settings, in_race, point);
      if (!rung || (!settings.empty() && loses(rungs.size(), point.median_seconds() / luck))) break;
      rungs.push_back(*rung);
      fastest.push_back(std::move(point));
      log_rest -= std::log(0.5 * place.best_seconds);
      const double sum = log_rest + std::log(mean_of(fastest)) * static_cast<double>(rungs.size());
      if (sum / static_cast<double>(places_.size()) > std::log(hopeless)) break;
    }
    std::optional<double> mean;
    if (fastest.size() == places_.size()) {
      // One run is enough to say of what is slower that it is not better.
      if (!in_race || mean_of(fastest) < lowest_) repeat(fastest);
      mean = mean_of(fastest);
    }
    for (std::size_t i = 0; mean && i < places_.size() && !settings.empty(); ++i)
      if (loses(i, fastest[i].median_seconds())) mean.reset();
    tell(settings, mean);
    if (mean) learn(values, rungs, fastest);
    return mean;
  }

  void repeat(std::vector<PointResult>& points) {
    for (int i = 1; i < samples; ++i) {
      for (PointResult& point : points)
        runners_.repeat(point, {options_.timeout, 1e300, options_.interrupted, nullptr});
    }
  }

  void learn(const Values& values, const std::vector<std::size_t>& rungs,
             const std::vector<PointResult>& fastest) {
    lowest_ = std::min(lowest_, mean_of(fastest));
    std::vector<Found> found;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      found.push_back({rungs[i], fastest[i].median_seconds()});
      if (found[i].seconds >= places_[i].best_seconds) continue;
      places_[i].best_seconds = found[i].seconds;
      places_[i].best_rung = rungs[i];
    }
    last_[values] = std::move(found);
  }

  // The rung of the fastest, which goes to `fastest`: from the best step so far to both sides, as
  // long as it gets faster. in_race: what is much slower than what is known is not run to its end.
  std::optional<std::size_t> best_step(Place& place, const inextensible::Settings& settings,
                                       bool in_race, PointResult& fastest) {
    std::optional<std::size_t> best;
    const auto faster = [&](std::size_t rung) {
      const double most = best      ? fastest.median_seconds()
                          : in_race ? give_up_at * place.best_seconds
                                    : 1e300;
      PointResult point = run_once(place, rung, settings, most);
      if (!point.ok() || (best && point.median_seconds() >= fastest.median_seconds())) return false;
      best = rung;
      fastest = std::move(point);
      return true;
    };
    const std::size_t start = place.best_rung, rungs = place.search.ladder.size();
    faster(start);
    std::size_t finer = start + 1;
    while (finer < rungs && faster(finer)) ++finer;
    const bool moved = best && *best > start;
    for (std::size_t coarser = start; !moved && coarser > 0 && faster(coarser - 1);) --coarser;
    return best;
  }

  void tell(const inextensible::Settings& settings, const std::optional<double>& mean) {
    options_.tell(
        entry_.kind + "/" + entry_.solver + " " + to_json(settings).dump() + ": " +
        (mean ? duration_text(*mean) + "/s" : std::string("fails, too slow, or slower somewhere")));
  }

  TuneOptions options_;
  SweepRunners runners_;
  std::vector<Place> places_;
  std::vector<TunedNumber> numbers_;
  std::map<Values, std::vector<Found>> last_;  // of the last time that they were measured
  double lowest_ = 1e300;                      // mean of what was run several times
  TunedEntry entry_;
};

SweepSpec tuning_scene(const char* scene, std::vector<int> sizes, double coarsest,
                       double duration) {
  SweepSpec spec;
  spec.sweep = "strain";
  spec.scene = scene;
  spec.limits = {0.1, 0.01, 0.001, 0.0001};
  spec.resolutions = std::move(sizes);
  spec.coarsest = coarsest;
  spec.finest = 1.0 / 6400;
  spec.scene_parameters = {{"duration", duration}};
  return spec;
}

}  // namespace

std::vector<SweepSpec> tuning_scenes() {
  // The drape is hardest from 0.3 s on, where it has sheared.
  return {tuning_scene("chain", {50, 200}, 0.2, 1), tuning_scene("drape", {17, 45}, 0.02, 0.6),
          tuning_scene("patch", {13, 23}, 0.02, 1)};
}

TunedEntry tune_solver(const std::string& solver, const SweepSpec& scene,
                       const TuneOptions& options, const SweepRunners& runners) {
  return Tuner(solver, scene, options, runners).run();
}

}  // namespace harness
