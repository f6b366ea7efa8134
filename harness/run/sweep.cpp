#include "harness/run/sweep.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "harness/base/errors.h"

namespace harness {
namespace {

// A run that has stepped for this many times the best one's time cannot be the best; its time has
// risen.
constexpr double hopeless_factor = 3;
constexpr double hopeless_least = 0.2;  // s; shorter runs are always finished
// Points that take longer than this are not repeated: their spread is small against what they cost.
constexpr double repeat_up_to = 20;  // s

bool selected(const SweepFilters& filters, const PointSpec& spec) {
  const std::string id = spec.id();
  return (!filters.include || std::regex_search(id, *filters.include)) &&
         (!filters.exclude || !std::regex_search(id, *filters.exclude));
}

std::vector<double> step_ladder(const SweepSpec& sweep) {
  if (sweep.adaptive) return {sweep.coarsest};
  std::vector<double> ladder;
  for (double h = sweep.coarsest; h >= sweep.finest * (1 - 1e-9); h /= 2) ladder.push_back(h);
  return ladder;
}

// The step search of docs/measuring.md: from coarse to fine until the time has risen twice in a
// row; with a neighbour's best step, from there in both directions. A failure counts as a rise, and
// before the first success as a reason to go finer. Points that miss max_error count as failures;
// once that error has grown twice in a row towards finer steps (slack within the limit then
// dominates it), finer ones are hopeless.
class StepSearch {
 public:
  using Run = std::function<const PointResult&(std::size_t rung)>;
  StepSearch(std::size_t rungs, Run run, double max_error = std::numeric_limits<double>::infinity())
      : rungs_(rungs), run_(std::move(run)), max_error_(max_error) {}

  // The best rung; none if every step failed.
  std::optional<std::size_t> find(std::optional<std::size_t> start) {
    const std::size_t first = std::min(start.value_or(0), rungs_ - 1);
    walk(first, +1);
    if (first > 0) walk(first - 1, -1);
    return best_;
  }

  // Every rung from coarse to fine, until two in a row have timed out; the fastest.
  std::optional<std::size_t> find_among_all() {
    int timeouts = 0;
    for (std::size_t rung = 0; rung < rungs_ && timeouts < 2; ++rung) {
      const PointResult& point = run_(rung);
      consider(rung, point);
      timeouts = point.status == PointStatus::timeout ? timeouts + 1 : 0;
    }
    return best_;
  }

  bool timed_out() const { return timed_out_; }

 private:
  bool permissible(const PointResult& point) const {
    return point.ok() && (std::isinf(max_error_) || point.measures.trajectory <= max_error_);
  }

  bool consider(std::size_t rung, const PointResult& point) {
    if (!permissible(point) || (best_ && point.median_seconds() >= best_seconds_)) return false;
    best_ = rung;
    best_seconds_ = point.median_seconds();
    return true;
  }

  void walk(std::size_t from, int direction) {
    int rises = 0, timeouts = 0, error_rises = 0;
    double last_error = std::numeric_limits<double>::infinity();
    for (std::size_t rung = from; rung < rungs_;
         rung += static_cast<std::size_t>(direction)) {  // wraps below 0
      const PointResult& point = run_(rung);
      if (consider(rung, point)) {
        rises = 0;
      } else if (best_ || direction < 0) {
        ++rises;
      }
      if (point.status == PointStatus::timeout) {
        timed_out_ = true;
        ++timeouts;
      }
      if (point.ok() && !permissible(point)) {
        error_rises = point.measures.trajectory > last_error ? error_rises + 1 : 0;
        last_error = point.measures.trajectory;
      }
      if (rises == 2 || timeouts == 2 || error_rises == 2) return;
    }
  }

  std::size_t rungs_;
  Run run_;
  double max_error_;
  std::optional<std::size_t> best_;
  double best_seconds_ = 0;
  bool timed_out_ = false;
};

void repeat_best(const Suite& suite, std::vector<PointResult>& points, const SweepEvents& events,
                 const SweepRunners& runners) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double seconds =
        points[i].median_seconds() * points[i].spec.step * points[i].steps_planned;
    const bool wanted =
        points[i].spec.sweep == "step" ? points[i].ok() : points[i].best || points[i].best_at_error;
    if (wanted && seconds <= repeat_up_to) order.push_back(i);
  }
  if (order.empty()) return;  // GSL's shuffle does not take nothing
  const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                 gsl_rng_free);
  gsl_rng_set(random.get(), suite.seed);
  const int most = std::max(suite.reps, suite.most_reps);
  std::size_t done = 0;
  for (int rep = 1; rep < most; ++rep) {
    if (rep >= suite.reps) {
      std::erase_if(order, [&](std::size_t i) {
        return median_uncertainty(points[i].samples) <= suite.rel_ci;
      });
      if (order.empty()) return;
    }
    const std::size_t all = done + order.size() * static_cast<std::size_t>(
                                                      (rep < suite.reps ? suite.reps : most) - rep);
    gsl_ran_shuffle(random.get(), order.data(), order.size(), sizeof(std::size_t));
    for (const std::size_t i : order) {
      runners.repeat(points[i], {suite.timeout, 1e300, events.interrupted, nullptr});
      events.repetition(++done, all);
    }
  }
}

}  // namespace

std::vector<Search> plan(const Suite& suite, const SweepFilters& filters) {
  std::vector<Search> searches;
  std::size_t family = 0;
  for (const SweepSpec& sweep : suite.sweeps) {
    const SceneType& type = *find_scene(sweep.scene);
    std::vector<double> limits = sweep.limits;
    std::sort(limits.rbegin(), limits.rend());  // loose to tight
    std::vector<int> resolutions = sweep.resolutions;
    std::sort(resolutions.begin(), resolutions.end());
    for (const std::string& solver : sweep.solvers) {
      if (filters.solver && !std::regex_match(solver, *filters.solver)) continue;
      for (const int resolution : resolutions) {
        SceneParameters given = sweep.scene_parameters;
        given[type.resolution] = resolution;
        PointSpec base;
        base.sweep = sweep.sweep;
        base.scene = sweep.scene;
        base.scene_parameters = complete_parameters(type, given);
        base.resolution = resolution;
        const auto [vertices, constraints] = type.counts(base.scene_parameters);
        base.vertices = vertices;
        base.constraints = constraints;
        base.solver = solver;
        if (const auto options = sweep.solver_options.find(solver);
            options != sweep.solver_options.end()) {
          base.settings = options->second;
        }
        base.seed = suite.seed;
        base.adaptive = sweep.adaptive;
        for (const double limit : limits) {
          Search search{base, {}, family, sweep.every_step || sweep.sweep == "step"};
          search.base.strain_limit = limit;
          for (const double step : step_ladder(sweep)) {
            search.base.step = step;
            if (selected(filters, search.base)) search.ladder.push_back(step);
          }
          if (!search.ladder.empty()) searches.push_back(std::move(search));
        }
        ++family;
      }
    }
  }
  if (searches.empty())
    throw UsageError("no point is left: the filters exclude every point of the suite");
  return searches;
}

std::vector<Search> shard(std::vector<Search> searches, const Shard& part) {
  // Work grows with constraints times limits.
  std::map<std::pair<std::string, SceneParameters>, double> load;
  const auto group = [](const Search& s) {
    return std::pair(s.base.scene, s.base.scene_parameters);
  };
  for (const Search& s : searches) load[group(s)] += s.base.constraints;
  std::vector<std::pair<double, std::pair<std::string, SceneParameters>>> largest;
  largest.reserve(load.size());
  for (const auto& [name, size] : load) largest.emplace_back(size, name);
  std::stable_sort(largest.begin(), largest.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<double> filled(part.count, 0);
  std::map<std::pair<std::string, SceneParameters>, std::size_t> place;
  for (const auto& [size, name] : largest) {
    const auto least = std::min_element(filled.begin(), filled.end());
    *least += size;
    place[name] = static_cast<std::size_t>(least - filled.begin()) + 1;
  }
  std::erase_if(searches, [&](const Search& s) { return place.at(group(s)) != part.index; });
  return searches;
}

SweepOutcome run_sweep(const Suite& suite, const std::vector<Search>& searches,
                       const SweepEvents& events, const SweepRunners& runners) {
  SweepOutcome outcome;
  struct Neighbour {  // what a family's last search found
    std::optional<double> best_step;
    std::map<double, double>
        stiffness_times_limit;  // by step: a spring's strain is tension over stiffness
    bool hopeless = false;      // only time-outs
  };
  std::map<std::size_t, Neighbour> neighbours;
  try {
    for (std::size_t s = 0; s < searches.size(); ++s) {
      const Search& search = searches[s];
      Neighbour& neighbour = neighbours[search.family];
      if (neighbour.hopeless) {
        PointResult skipped;
        skipped.spec = search.base;
        skipped.spec.step = search.ladder.front();
        skipped.detail = "every step timed out at the neighbouring point of the axis already";
        outcome.points.push_back(std::move(skipped));
        events.point(outcome.points.back(), s, searches.size());
        continue;
      }
      const bool every_step = search.every_step;
      double best_run = 1e300;  // s
      std::map<std::size_t, std::size_t> point_of_rung;
      const auto run = [&](std::size_t rung) -> const PointResult& {
        if (const auto known = point_of_rung.find(rung); known != point_of_rung.end())
          return outcome.points[known->second];
        PointSpec spec = search.base;
        spec.step = search.ladder[rung];
        std::optional<double> guess;
        if (const auto known = neighbour.stiffness_times_limit.find(spec.step);
            known != neighbour.stiffness_times_limit.end()) {
          guess = known->second / spec.strain_limit;
        } else if (!neighbour.stiffness_times_limit.empty()) {
          guess = neighbour.stiffness_times_limit.begin()->second / spec.strain_limit;
        }
        // A slower run may still be the best one of those within an error limit.
        const double hopeless = every_step || suite.max_error > 0
                                    ? 1e300
                                    : std::max(hopeless_least, hopeless_factor * best_run);
        PointResult point = runners.run(
            spec, {suite.timeout, hopeless, events.interrupted, runners.references}, guess);
        if (point.stiffness)
          neighbour.stiffness_times_limit[spec.step] = *point.stiffness * spec.strain_limit;
        if (point.ok())
          best_run = std::min(best_run, point.median_seconds() * spec.step * point.steps_planned);
        point_of_rung[rung] = outcome.points.size();
        outcome.points.push_back(std::move(point));
        events.point(outcome.points.back(), s, searches.size());
        return outcome.points.back();
      };
      std::optional<std::size_t> start;
      if (neighbour.best_step) {
        const auto near = std::find_if(search.ladder.begin(), search.ladder.end(), [&](double h) {
          return h <= *neighbour.best_step * (1 + 1e-9);
        });
        start = static_cast<std::size_t>(near - search.ladder.begin());
      }
      StepSearch steps(search.ladder.size(), run);
      const auto best = every_step ? steps.find_among_all() : steps.find(start);
      if (suite.max_error > 0 && !every_step) {
        StepSearch within(search.ladder.size(), run, suite.max_error);
        if (const auto found = within.find(best))
          outcome.points[point_of_rung.at(*found)].best_at_error = true;
      }
      if (best) {
        outcome.points[point_of_rung.at(*best)].best = true;
        neighbour.best_step = search.ladder[*best];
      } else {
        neighbour.hopeless = steps.timed_out();
      }
    }
    repeat_best(suite, outcome.points, events, runners);
  } catch (const Interrupted&) {
    outcome.complete = false;
  }
  return outcome;
}

}  // namespace harness
