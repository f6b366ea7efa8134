#include "harness/run/sweep.h"

#include <random>
#include <set>

#include "harness/run/step_search.h"

namespace harness {
namespace {

constexpr double hopeless_least = 0.2;  // s; shorter runs are always finished
// Steps whose time is within this factor of the best are repeated before one is called best.
constexpr double candidate_factor = 1.2;
// Candidates in suites that ask for this many samples are run for at least 0.2 s. So many samples
// can tell two points apart even if one sample was disturbed.
constexpr int full_reps = 7;
constexpr double least_measured = 0.2;  // s
constexpr int other_reps = 5;           // at most, of the other points of a step sweep

// The candidates of one search: their places in the outcome, by rung.
struct Choice {
  double level;       // of error
  std::size_t rungs;  // of the whole ladder
  std::map<std::size_t, std::size_t> candidates = {};
};

const char* ladder_end(std::size_t rung, std::size_t rungs) {
  if (rungs < 2) return "";
  return rung == 0 ? "coarsest" : rung + 1 == rungs ? "finest" : "";
}

// Marks the best points by all samples so far.
void choose(const std::vector<Choice>& choices, std::vector<PointResult>& points) {
  for (const Choice& choice : choices) {
    const auto [rung, place] = *std::ranges::min_element(
        choice.candidates, {}, [&](const auto& one) { return points[one.second].seconds(); });
    PointResult& point = points[place];
    if (choice.level == any_motion)
      point.best = true;
    else
      point.best_at_errors.push_back(choice.level);
    point.at_ladder_end = ladder_end(rung, choice.rungs);
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

  // The first rung of another ladder that is not coarser than the best step.
  std::optional<std::size_t> rung_in(const std::vector<double>& ladder) const {
    if (!best_step) return std::nullopt;
    const auto near =
        std::ranges::find_if(ladder, [&](double h) { return h <= *best_step * (1 + 1e-9); });
    return static_cast<std::size_t>(near - ladder.begin());
  }
};

// Where contestants are compared: scene, parameters, limit, and the step in a search of all steps.
using MeetingPlace = std::tuple<std::string, SceneParameters, double, double>;

struct Sweep {
  const Suite& suite;
  const std::vector<Search>& searches;
  const SweepEvents& events;
  const Runner& run;
  std::vector<PointResult>& points;
  std::vector<Choice> choices = {};
  // s/s; the fastest run at each place whose motion error, if known, is within the headline's.
  std::map<MeetingPlace, double> fastest = {};

  void remember(const MeetingPlace& place, const PointResult& point) {
    if (!point.ok() || !within_known_error(point.measures, headline_error)) return;
    double& least = fastest.try_emplace(place, point.seconds()).first->second;
    least = std::min(least, point.seconds());
  }
  // Seconds per simulated second from which a run is far behind what is known of its place.
  double far_behind(const MeetingPlace& place) const {
    const auto known = fastest.find(place);
    return known == fastest.end() ? std::numeric_limits<double>::infinity()
                                  : suite.far_behind * known->second;
  }

  const PointResult& add(PointResult point, std::size_t search) {
    // The judge has not seen a point that was skipped or whose process ended early.
    Measures& measures = point.measures;
    if (std::isnan(measures.trajectory) && measures.unknown_because.empty())
      measures.unknown_because = "no run came to an end that could be judged";
    points.push_back(std::move(point));
    events.point(points.back(), search, searches.size());
    return points.back();
  }

  void repeat(PointResult& point) {
    add_sample(point, run, {.timeout = suite.timeout, .interrupted = events.interrupted});
  }

  void find_best(std::size_t search, Neighbour& neighbour);
  void repeat_candidates();
};

// A point of which more samples are to be taken.
struct Repeated {
  std::size_t point;
  bool may_be_best;
  int tries, least;  // samples
};

// One sample of each per round, in a shuffled order, until each has enough. As they are taken at
// different times and the shortest counts, none waits for a quiet core.
void repeat_in_rounds(const Suite& suite, std::vector<Repeated> round,
                      std::vector<PointResult>& points, const SweepEvents& events,
                      const Runner& run) {
  const auto enough = [&](const Repeated& one) {
    const PointResult& point = points[one.point];
    const double seconds = point.measured_seconds();
    if (seconds >= repeat_for) return true;
    if (one.tries < one.least) return false;
    const bool full = one.may_be_best && suite.reps >= full_reps;
    return !full || seconds >= least_measured || one.tries >= 2 * suite.reps;
  };
  std::mt19937_64 random(suite.seed);
  std::size_t done = 0;
  for (std::erase_if(round, enough); !round.empty(); std::erase_if(round, enough)) {
    std::size_t all = done;  // about
    for (const Repeated& one : round)
      all += static_cast<std::size_t>(std::max(1, one.least - one.tries));
    std::ranges::shuffle(round, random);
    for (Repeated& one : round) {
      add_sample(points[one.point], run,
                 {.timeout = suite.timeout, .interrupted = events.interrupted, .longest_wait = 0});
      ++one.tries;
      events.repetition(++done, all);
    }
  }
}

// Candidates, and in a step sweep every point that ran to the end.
void Sweep::repeat_candidates() {
  std::set<std::size_t> candidates;
  for (const Choice& choice : choices)
    for (const auto& [rung, place] : choice.candidates) candidates.insert(place);
  std::vector<Repeated> round;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool may_be_best = candidates.contains(i);
    if (points[i].spec.sweep == "step" ? points[i].ok() : may_be_best)
      round.push_back({i, may_be_best, static_cast<int>(points[i].samples.size()),
                       may_be_best ? suite.reps : std::min(suite.reps, other_reps)});
  }
  repeat_in_rounds(suite, std::move(round), points, events, run);
}

void Sweep::find_best(std::size_t number, Neighbour& neighbour) {
  const Search& search = searches[number];
  std::map<std::size_t, std::size_t> place_of_rung;
  // A run was stopped because others are faster; at the next limit it may be closer to them.
  bool was_far_behind = false;
  const auto try_rung = [&](std::size_t rung, double longest_useful) -> const PointResult& {
    if (const auto known = place_of_rung.find(rung); known != place_of_rung.end())
      return points[known->second];
    PointSpec spec = search.base;
    spec.step = search.ladder[rung];
    const MeetingPlace place{spec.scene, spec.scene_parameters, spec.strain_limit,
                             search.every_step ? spec.step : 0};
    const double behind = far_behind(place), useful = std::min(longest_useful, behind);
    const double hopeless =
        std::isinf(useful)
            ? 1e300
            : std::max(hopeless_least, useful * spec.scene_parameters.at("duration"));
    PointResult point = run(spec, {.timeout = suite.timeout,
                                   .hopeless = hopeless,
                                   .interrupted = events.interrupted,
                                   .stiffness_guess = neighbour.guess_of_stiffness(spec)});
    if (point.stiffness)
      neighbour.stiffness_times_limit[spec.step] = *point.stiffness * spec.strain_limit;
    was_far_behind = was_far_behind || (point.status == PointStatus::timeout && useful == behind &&
                                        std::isfinite(behind));
    remember(place, point);
    place_of_rung[rung] = points.size();
    return add(std::move(point), number);
  };
  const auto again = [&](std::size_t rung) {
    PointResult& point = points[place_of_rung.at(rung)];
    if (point.measured_seconds() < repeat_for) repeat(point);
  };
  const BestSteps found =
      find_best_steps({search.ladder.size(), try_rung, again, levels_of(suite), search.stride,
                       neighbour.rung_in(search.ladder), search.every_step});
  if (!found.best) {
    neighbour.hopeless = found.timed_out && !was_far_behind;
    return;
  }
  neighbour.best_step = search.ladder[*found.best];
  for (auto at = found.seconds.rbegin(); at != found.seconds.rend(); ++at) {  // loose to tight
    const auto& [level, times] = *at;
    Choice& choice = choices.emplace_back(Choice{level, search.ladder.size()});
    const double least =
        std::ranges::min_element(times, {}, [](const auto& one) { return one.second; })->second;
    for (const auto& [rung, seconds] : times)
      if (seconds <= candidate_factor * least) choice.candidates[rung] = place_of_rung.at(rung);
  }
}

}  // namespace

SweepOutcome run_sweep(const Suite& suite, const std::vector<Search>& searches,
                       const SweepEvents& events, const Runner& run) {
  SweepOutcome outcome;
  Sweep sweep{suite, searches, events, run, outcome.points};
  std::map<std::size_t, Neighbour> neighbours;
  try {
    for (std::size_t s = 0; s < searches.size(); ++s) {
      Neighbour& neighbour = neighbours[searches[s].family];
      if (neighbour.hopeless) {
        PointResult skipped(searches[s].base);
        skipped.spec.step = searches[s].ladder.front();
        skipped.detail = "every step timed out at the neighbouring point of the axis already";
        sweep.add(std::move(skipped), s);
      } else {
        sweep.find_best(s, neighbour);
      }
    }
    sweep.repeat_candidates();
  } catch (const Interrupted&) {
    outcome.complete = false;
  }
  choose(sweep.choices, outcome.points);
  return outcome;
}

std::vector<Samples> time_again(const Suite& suite, const std::vector<PointResult>& points,
                                const SweepEvents& events, const Runner& run) {
  std::vector<PointResult> again;
  std::vector<Repeated> round;
  for (const PointResult& point : points) {
    PointResult more(point);
    static_cast<Samples&>(more) =
        run(point.spec,
            {.timeout = suite.timeout, .interrupted = events.interrupted, .sample_of = &point});
    if (!more.samples.empty()) round.push_back({again.size(), true, 1, suite.reps});
    again.push_back(std::move(more));
    events.point(again.back(), again.size() - 1, points.size());
  }
  repeat_in_rounds(suite, std::move(round), again, events, run);
  return {again.begin(), again.end()};
}

}  // namespace harness
