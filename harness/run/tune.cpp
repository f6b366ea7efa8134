#include "harness/run/tune.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "harness/base/text.h"
#include "harness/points/point_json.h"
#include "harness/run/step_search.h"

namespace harness {
namespace {

constexpr double give_up_at = 2.5;    // times the time that is known at a place
constexpr double far_too_long = 4;    // times options.longest_run: no step of a short one takes it
constexpr double no_use_above = 1.2;  // times the time without settings: that would count instead
constexpr int samples = 3;            // of the best steps

// Whether a run ran to the end with a motion that is right to the headline's error, or of which
// nothing is known.
bool counts(const PointResult& point) {
  return point.ok() && within_known_error(point.measures, headline_error);
}

// One size and strain limit of the scene, and what is known there.
struct Place {
  Search search;
  std::optional<double> stiffness = {};  // to begin calibrations from
  std::size_t best_rung = 0;             // of the best time so far; where the next search begins
  double best_seconds = 1e300;           // s/s
};

struct Found {
  std::optional<std::size_t> rung = {};  // of the best step; none: all that were tried fail
  double seconds = 0;                    // s/s
};

class Tuner {
 public:
  Tuner(const std::string& solver, const SweepSpec& scene, const TuneOptions& options,
        const SweepRunners& runners)
      : options_(options), runners_(runners) {
    scene_ = scene;
    scene_.contestants = {{solver, solver}};
    scene_.refine = false;
    places_ = places_of(scene_);
    numbers_ = tunable_numbers(*inextensible::find_backend(solver));
    options_.rules.budget =
        std::min(options.rules.budget, options.trials_each * static_cast<int>(numbers_.size()));
    entry_.kind = find_scene(scene.scene)->kind();
    entry_.solver = solver;
    entry_.budget = options_.rules.budget;
    entry_.rule = tuning_rule(scene, *inextensible::find_backend(solver));
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
      const auto step = [&](const Found& found) {
        return found.rung ? places_[i].search.ladder[*found.rung] : unknown;
      };
      const Found &before = was->second[i], &now = is->second[i];
      const PointSpec& base = places_[i].search.base;
      entry_.places.push_back({base.resolution, base.strain_limit, before.seconds, step(before),
                               now.rung ? now.seconds : unknown, step(now)});
    }
    std::sort(entry_.places.begin(), entry_.places.end(), [](const auto& a, const auto& b) {
      return std::pair(a.resolution, -a.limit) < std::pair(b.resolution, -b.limit);
    });
    return entry_;
  }

 private:
  static std::vector<Place> places_of(const SweepSpec& scene) {
    Suite suite;
    suite.sweeps = {scene};
    std::vector<Place> places;
    for (Search& search : plan(suite, {})) places.push_back({.search = std::move(search)});
    return places;
  }

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
    const double hopeless = std::max(0.05, most_seconds * duration(place));
    PointResult point =
        runners_.run(what, {options_.timeout, hopeless, options_.interrupted, runners_.references},
                     place.stiffness);
    if (point.stiffness) place.stiffness = point.stiffness;
    return point;
  }

  // The ladder's best step with the settings that the solver has by itself, at a smaller size where
  // that takes too long. Places where no step counts at any size say nothing about settings.
  void begin() {
    const std::vector<int> smaller_ones = smaller_sizes(scene_.scene);
    for (Place& place : places_) {
      find_best(place, far_too_long * options_.longest_run);
      for (const int size : smaller_ones) {
        if (place.best_seconds * duration(place) <= options_.longest_run) break;
        if (size >= place.search.base.resolution) continue;
        SweepSpec smaller = scene_;
        smaller.resolutions = {size};
        smaller.limits = {place.search.base.strain_limit};
        place = places_of(smaller).front();
        const bool last = size == smaller_ones.back();
        find_best(place, last ? 1e300 : far_too_long * options_.longest_run);
      }
    }
    std::erase_if(places_, [](const Place& place) { return place.best_seconds >= 1e300; });
    std::stable_sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
      return a.best_seconds < b.best_seconds;
    });
  }

  static double duration(const Place& place) {
    return place.search.base.scene_parameters.at("duration");
  }

  void find_best(Place& place, double most_seconds) {
    std::map<std::size_t, PointResult> known;
    double best = most_seconds / duration(place) / give_up_at;
    const auto run = [&](std::size_t rung) -> const PointResult& {
      const auto [at, fresh] = known.try_emplace(rung);
      if (fresh) at->second = run_once(place, rung, {}, give_up_at * best);
      if (counts(at->second)) best = std::min(best, at->second.seconds());
      return at->second;
    };
    const auto again = [&](std::size_t rung) -> const PointResult& {
      runners_.repeat(known.at(rung), {options_.timeout, 1e300, options_.interrupted, nullptr});
      return known.at(rung);
    };
    StepSearch(place.search.ladder.size(), run, again, {headline_error}).find(std::nullopt);
    for (const auto& [rung, point] : known) {
      if (!counts(point) || point.seconds() >= place.best_seconds) continue;
      place.best_rung = rung;
      place.best_seconds = point.seconds();
    }
  }

  // Geometric mean, over the places, of the faster of these settings and none; none if that is
  // bound to be above `hopeless`.
  std::optional<double> evaluate(const Values& values, double hopeless) {
    const inextensible::Settings settings = settings_of(values);
    const bool in_race = hopeless < 1e300;
    const auto own = last_.find(values);
    std::vector<Found> found;
    std::vector<PointResult> points;
    const auto without = [&](std::size_t i) {
      return settings.empty() ? 1e300 : last_.at(initial())[i].seconds;
    };
    const auto log_sum = [&] {  // over the places so far
      double sum = 0;
      for (std::size_t i = 0; i < found.size(); ++i)
        sum += std::log(std::min(found[i].seconds, without(i)));
      return sum;
    };
    const auto count = static_cast<double>(places_.size());
    double log_rest = 0;
    for (const Place& place : places_) log_rest += std::log(0.5 * place.best_seconds);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      PointResult point;
      const std::size_t start = own == last_.end()
                                    ? places_[i].best_rung
                                    : own->second[i].rung.value_or(places_[i].best_rung);
      const auto rung = best_step(places_[i], settings, start, in_race ? 1 : 2, without(i), point);
      if (!rung && settings.empty()) break;
      found.push_back({rung, rung ? point.seconds() : 1e300});
      points.push_back(std::move(point));
      log_rest -= std::log(0.5 * places_[i].best_seconds);
      if (in_race && (log_sum() + log_rest) / count > std::log(hopeless)) break;
    }
    std::optional<double> mean;
    if (found.size() == places_.size()) {
      mean = std::exp(log_sum() / count);
      // One run is enough to say of what is slower that it is not better.
      if (!in_race || *mean < lowest_) {
        repeat(points, found);
        mean = std::exp(log_sum() / count);
        lowest_ = std::min(lowest_, *mean);
      }
    }
    tell(settings, mean);
    if (mean) learn(values, std::move(found));
    return mean;
  }

  void repeat(std::vector<PointResult>& points, std::vector<Found>& found) {
    for (int i = 1; i < samples; ++i) {
      for (std::size_t p = 0; p < points.size(); ++p) {
        if (!found[p].rung) continue;
        runners_.repeat(points[p], {options_.timeout, 1e300, options_.interrupted, nullptr});
        found[p].seconds = points[p].seconds();
      }
    }
  }

  void learn(const Values& values, std::vector<Found> found) {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (!found[i].rung || found[i].seconds >= places_[i].best_seconds) continue;
      places_[i].best_seconds = found[i].seconds;
      places_[i].best_rung = *found[i].rung;
    }
    last_[values] = std::move(found);
  }

  // The rung of the fastest step, whose run goes to `fastest`: from `start` to both sides, until
  // `patience` steps in a row are not faster. What takes longer than `enough` is of no use.
  std::optional<std::size_t> best_step(Place& place, const inextensible::Settings& settings,
                                       std::size_t start, int patience, double enough,
                                       PointResult& fastest) {
    std::optional<std::size_t> best;
    const auto faster = [&](std::size_t rung) {
      const double most = best ? fastest.seconds() : no_use_above * enough;
      PointResult point = run_once(place, rung, settings, most);
      if (!counts(point) || (best && point.seconds() >= fastest.seconds())) return false;
      best = rung;
      fastest = std::move(point);
      return true;
    };
    faster(start);
    const auto go = [&](int direction) {
      int in_vain = 0;
      for (auto at = static_cast<int>(start) + direction;
           in_vain < patience && at >= 0 && at < static_cast<int>(place.search.ladder.size());
           at += direction)
        in_vain = faster(static_cast<std::size_t>(at)) ? 0 : in_vain + 1;
    };
    go(1);
    go(-1);
    return best;
  }

  void tell(const inextensible::Settings& settings, const std::optional<double>& mean) {
    options_.tell(entry_.kind + "/" + entry_.solver + " " + to_json(settings).dump() + ": " +
                  (mean ? duration_text(*mean) + "/s" : std::string("too slow")));
  }

  TuneOptions options_;
  SweepRunners runners_;
  SweepSpec scene_;
  std::vector<Place> places_;
  std::vector<TunedNumber> numbers_;
  std::map<Values, std::vector<Found>> last_;  // of the last time that all were measured
  double lowest_ = 1e300;                      // mean of what was run several times
  TunedEntry entry_;
};

}  // namespace

TunedEntry tune_solver(const std::string& solver, const SweepSpec& scene,
                       const TuneOptions& options, const SweepRunners& runners) {
  return Tuner(solver, scene, options, runners).run();
}

}  // namespace harness
