#include "harness/run/sweep.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "harness/run/step_search.h"

namespace harness {
namespace {

constexpr double hopeless_least = 0.2;  // s; shorter runs are always finished
// Steps whose one time is within this factor of the best are repeated before one is called best.
constexpr double candidate_factor = 1.2;

// What may be the best point of one search, by rung; the points' place in the outcome.
struct Choice {
  std::map<std::size_t, std::size_t> candidates;
  std::size_t rungs = 0;      // of the whole ladder
  double level = any_motion;  // of error
};

const char* ladder_end(std::size_t rung, std::size_t rungs) {
  if (rungs < 2) return "";
  return rung == 0 ? "coarsest" : rung + 1 == rungs ? "finest" : "";
}

// By the medians of all runs so far.
void choose(const std::vector<Choice>& choices, std::vector<PointResult>& points) {
  for (const Choice& choice : choices) {
    const auto best = std::min_element(
        choice.candidates.begin(), choice.candidates.end(), [&](const auto& a, const auto& b) {
          return points[a.second].median_seconds() < points[b.second].median_seconds();
        });
    if (best == choice.candidates.end()) continue;
    PointResult& point = points[best->second];
    if (choice.level == any_motion) {
      point.best = true;
    } else {
      point.best_at_errors.push_back(choice.level);
    }
    point.at_ladder_end = ladder_end(best->first, choice.rungs);
  }
}

void repeat_candidates(const Suite& suite, const std::vector<Choice>& choices,
                       std::vector<PointResult>& points, const SweepEvents& events,
                       const SweepRunners& runners) {
  std::set<std::size_t> candidates;
  for (const Choice& choice : choices) {
    for (const auto& candidate : choice.candidates) candidates.insert(candidate.second);
  }
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool wanted = points[i].spec.sweep == "step" ? points[i].ok() : candidates.contains(i);
    if (wanted) order.push_back(i);
  }
  const std::unique_ptr<gsl_rng, decltype(&gsl_rng_free)> random(gsl_rng_alloc(gsl_rng_mt19937),
                                                                 gsl_rng_free);
  gsl_rng_set(random.get(), suite.seed);
  const int most = std::max(suite.reps, suite.most_reps);
  std::size_t done = 0;
  const auto long_enough = [&](std::size_t i) {
    return static_cast<double>(points[i].samples.size()) * points[i].median_run() >= repeat_for;
  };
  for (int rep = 1; rep < most; ++rep) {
    std::erase_if(order, long_enough);
    if (rep >= suite.reps) {
      std::erase_if(order, [&](std::size_t i) {
        return median_uncertainty(points[i].samples) <= suite.rel_ci;
      });
    }
    if (order.empty()) return;  // GSL's shuffle does not take nothing
    const std::size_t all = done + order.size() * static_cast<std::size_t>(
                                                      (rep < suite.reps ? suite.reps : most) - rep);
    gsl_ran_shuffle(random.get(), order.data(), order.size(), sizeof(std::size_t));
    for (const std::size_t i : order) {
      runners.repeat(points[i], {suite.timeout, 1e300, events.interrupted, nullptr});
      events.repetition(++done, all);
    }
  }
}

// What a family's last search found.
struct Neighbour {
  std::optional<double> best_step;
  std::map<double, double>
      stiffness_times_limit;  // by step: a spring's strain is tension over stiffness
  bool hopeless = false;      // only time-outs

  std::optional<double> guess_of_stiffness(const PointSpec& spec) const {
    if (stiffness_times_limit.empty()) return std::nullopt;
    const auto known = stiffness_times_limit.find(spec.step);
    const auto near = known != stiffness_times_limit.end() ? known : stiffness_times_limit.begin();
    return near->second / spec.strain_limit;
  }

  // The rung of another ladder that comes next to the best step.
  std::optional<std::size_t> rung_in(const std::vector<double>& ladder) const {
    if (!best_step) return std::nullopt;
    const auto near = std::find_if(ladder.begin(), ladder.end(),
                                   [&](double h) { return h <= *best_step * (1 + 1e-9); });
    return static_cast<std::size_t>(near - ladder.begin());
  }
};

// What all searches of a sweep share.
struct Sweep {
  const Suite& suite;
  const std::vector<Search>& searches;
  const SweepEvents& events;
  const SweepRunners& runners;
  std::vector<PointResult>& points;
  std::vector<Choice> choices = {};

  const PointResult& add(PointResult point, std::size_t search) {
    // Of what no judge has seen: it was skipped, or its process ended early.
    Measures& measures = point.measures;
    if (std::isnan(measures.trajectory) && measures.unknown_because.empty())
      measures.unknown_because = "no run came to an end that could be judged";
    if (std::isnan(measures.shape) && measures.shape_unknown_because.empty())
      measures.shape_unknown_because = "no run came to an end that could be judged";
    points.push_back(std::move(point));
    events.point(points.back(), search, searches.size());
    return points.back();
  }
};

// One search: each rung of its ladder is run when it is first asked for.
class LadderRun {
 public:
  LadderRun(Sweep& sweep, std::size_t number, Neighbour& neighbour)
      : sweep_(sweep),
        number_(number),
        search_(sweep.searches[number]),
        neighbour_(neighbour),
        steps_(
            search_.ladder.size(),
            [this](std::size_t rung) -> const PointResult& { return point(rung); },
            levels_of(sweep.suite)) {}

  void find_best() {
    const auto best = search_.every_step ? steps_.find_among_all()
                                         : steps_.find(neighbour_.rung_in(search_.ladder));
    if (!best) {
      neighbour_.hopeless = steps_.timed_out();
      return;
    }
    neighbour_.best_step = search_.ladder[*best];
    add_choice(any_motion);
    for (const double level : levels_of(sweep_.suite)) add_choice(level);
  }

 private:
  const PointResult& point(std::size_t rung) {
    if (const auto known = point_of_rung_.find(rung); known != point_of_rung_.end())
      return sweep_.points[known->second];
    PointSpec spec = search_.base;
    spec.step = search_.ladder[rung];
    const double useful = steps_.longest_useful() * spec.scene_parameters.at("duration");
    const double hopeless =
        search_.every_step || std::isinf(useful) ? 1e300 : std::max(hopeless_least, useful);
    PointResult point = sweep_.runners.run(
        spec,
        {sweep_.suite.timeout, hopeless, sweep_.events.interrupted, sweep_.runners.references},
        neighbour_.guess_of_stiffness(spec));
    if (point.stiffness)
      neighbour_.stiffness_times_limit[spec.step] = *point.stiffness * spec.strain_limit;
    point_of_rung_[rung] = sweep_.points.size();
    return sweep_.add(std::move(point), number_);
  }

  void add_choice(double level) {
    Choice& choice = sweep_.choices.emplace_back();
    for (const std::size_t rung : steps_.near_best(level, candidate_factor))
      choice.candidates[rung] = point_of_rung_.at(rung);
    choice.rungs = search_.ladder.size();
    choice.level = level;
  }

  Sweep& sweep_;
  std::size_t number_;
  const Search& search_;
  Neighbour& neighbour_;
  StepSearch steps_;
  std::map<std::size_t, std::size_t> point_of_rung_;
};

PointResult skipped_point(const Search& search) {
  PointResult skipped;
  skipped.spec = search.base;
  skipped.spec.step = search.ladder.front();
  skipped.detail = "every step timed out at the neighbouring point of the axis already";
  return skipped;
}

}  // namespace

SweepOutcome run_sweep(const Suite& suite, const std::vector<Search>& searches,
                       const SweepEvents& events, const SweepRunners& runners) {
  SweepOutcome outcome;
  Sweep sweep{suite, searches, events, runners, outcome.points};
  std::map<std::size_t, Neighbour> neighbours;
  try {
    for (std::size_t s = 0; s < searches.size(); ++s) {
      Neighbour& neighbour = neighbours[searches[s].family];
      if (neighbour.hopeless) {
        sweep.add(skipped_point(searches[s]), s);
      } else {
        LadderRun(sweep, s, neighbour).find_best();
      }
    }
    repeat_candidates(suite, sweep.choices, outcome.points, events, runners);
  } catch (const Interrupted&) {
    outcome.complete = false;
  }
  choose(sweep.choices, outcome.points);
  return outcome;
}

}  // namespace harness
