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

// A run that has stepped for this many times the best one's time cannot be the best; its time has
// risen.
constexpr double hopeless_factor = 3;
constexpr double hopeless_least = 0.2;  // s; shorter runs are always finished
// Points that take longer than this are not repeated: their spread is small against what they cost.
constexpr double repeat_up_to = 20;  // s

// Steps whose one time is within this factor of the best are repeated before one is called best.
constexpr double candidate_factor = 1.2;

// What may be the best point of one search, by rung; the points' place in the outcome.
struct Choice {
  std::map<std::size_t, std::size_t> candidates;
  std::size_t rungs = 0;  // of the whole ladder
  bool PointResult::*mark = &PointResult::best;
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
    points[best->second].*choice.mark = true;
    points[best->second].at_ladder_end = ladder_end(best->first, choice.rungs);
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
    const double seconds =
        points[i].median_seconds() * points[i].spec.step * points[i].steps_planned;
    const bool wanted = points[i].spec.sweep == "step" ? points[i].ok() : candidates.contains(i);
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
  std::vector<Choice> choices;
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
      const auto add_choice = [&](const StepSearch& among, bool PointResult::*mark) {
        Choice& choice = choices.emplace_back();
        for (const std::size_t rung : among.near_best(candidate_factor))
          choice.candidates[rung] = point_of_rung.at(rung);
        choice.rungs = search.ladder.size();
        choice.mark = mark;
      };
      StepSearch steps(search.ladder.size(), run);
      const auto best = every_step ? steps.find_among_all() : steps.find(start);
      if (suite.max_error > 0 && !every_step) {
        StepSearch within(search.ladder.size(), run, suite.max_error);
        if (within.find(best)) add_choice(within, &PointResult::best_at_error);
      }
      if (best) {
        add_choice(steps, &PointResult::best);
        neighbour.best_step = search.ladder[*best];
      } else {
        neighbour.hopeless = steps.timed_out();
      }
    }
    repeat_candidates(suite, choices, outcome.points, events, runners);
  } catch (const Interrupted&) {
    outcome.complete = false;
  }
  choose(choices, outcome.points);
  return outcome;
}

}  // namespace harness
