// bench choose: which solver to take for a scene, at which step, and what a frame costs.
#include <algorithm>
#include <cmath>
#include <iostream>

#include "harness/analysis/words.h"
#include "harness/base/clock.h"
#include "harness/base/errors.h"
#include "harness/base/interrupt.h"
#include "harness/base/paths.h"
#include "harness/base/text.h"
#include "harness/base/timing_lock.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/shared_options.h"
#include "harness/cli/verbs.h"
#include "harness/judge/reference_routes.h"
#include "harness/points/point_json.h"
#include "harness/points/tuning_rule.h"
#include "harness/run/choose.h"
#include "harness/run/frame_times.h"
#include "harness/run/isolation.h"

namespace harness {
namespace {

using nlohmann::json;

constexpr double far_behind = 4;  // times the fastest so far: a run that takes longer is stopped
constexpr int finest_part = 32;   // of a frame: the smallest step
constexpr int finalists = 4;      // that are timed again, in turn
constexpr int final_samples = 7;  // of each
constexpr double search_share = 0.75;  // of the time; the rest is for finalists

struct ChooseCommand : SceneOptions {
  std::string budget, solver, limits = "0.01";
  double frames_per_second = 60, error = headline_error, seconds = 60;
  bool as_json = false, no_wait = false;
};

void check_rate(double rate) {
  if (std::find(std::begin(frame_rates), std::end(frame_rates), rate) == std::end(frame_rates))
    throw UsageError("--fps is " + number_text(rate) + ", must be 24, 30 or 60");
}

double limit_of(const ChooseCommand& given) {
  const std::vector<double> limits = numbers_of("--limit", given.limits, Bounds::strain());
  if (limits.size() != 1) throw UsageError("--limit is '" + given.limits + "', must be one limit");
  return limits.front();
}

// The record of a solver's time on scenes of this kind, at the place nearest to this one; those
// without a record come first, since nothing speaks against them.
double recorded_seconds(const Tuned& tuned, const std::string& kind, const std::string& solver,
                        double limit) {
  const TunedEntry* entry = tuned.find(kind, solver);
  double seconds = 0, nearest = 1e300;
  if (!entry) return seconds;
  for (const TunedPlace& place : entry->places) {
    const double distance = std::abs(std::log(place.limit / limit));
    if (distance > nearest) continue;
    nearest = distance;
    seconds = std::fmin(place.seconds, place.default_seconds);
  }
  return seconds;
}

Suite suite_of(const ChooseCommand& given, double rate) {
  const SceneParameters parameters = complete_parameters_of(given);
  const std::string scene = scene_of(given);
  const auto type = find_scene(scene);
  const double limit = limit_of(given);
  Suite suite;
  suite.name = "choose";
  suite.reps = 1;
  suite.finest_error = std::min(given.error, headline_error);
  suite.timeout = given.seconds;
  suite.far_behind = far_behind;
  SweepSpec& sweep = suite.sweeps.emplace_back();
  sweep.sweep = "strain";
  sweep.scene = scene;
  sweep.limits = {limit};
  sweep.scene_parameters = parameters;
  sweep.resolutions = {static_cast<int>(sweep.scene_parameters.at(type->resolution))};
  sweep.coarsest = 1 / rate;
  sweep.finest = sweep.coarsest / finest_part;
  const Pattern wanted("--solver", given.solver.empty() ? ".*" : given.solver);
  sweep.contestants = competitors(*type, parameters);
  std::erase_if(sweep.contestants, [&](const Contestant& c) { return !wanted.matches(c.name); });
  const Tuned tuned = read_tuned_up_to_date("tuned.json");
  tune(sweep.contestants, tuned, type->kind(), {}, Untuned::none);
  std::stable_sort(sweep.contestants.begin(), sweep.contestants.end(),
                   [&](const Contestant& a, const Contestant& b) {
                     return recorded_seconds(tuned, type->kind(), a.solver, limit) <
                            recorded_seconds(tuned, type->kind(), b.solver, limit);
                   });
  return suite;
}

// A kept reference, or a finer run made now, which is on the shelf then.
std::shared_ptr<const Reference> reference_for(const SweepSpec& sweep, ReferenceShelf& shelf) {
  if (auto kept = shelf.find(sweep.scene, sweep.scene_parameters)) return kept;
  std::cerr << "this scene has no reference: making a finer run in its place ...\n";
  try {
    auto made = std::make_shared<const Reference>(
        finer_run(sweep.scene, sweep.scene_parameters, [](const std::string& line) {
          if (interrupted()) throw Interrupted();
          std::cerr << line << '\n';
        }));
    shelf.put(made);
    return made;
  } catch (const UsageError& reason) {
    std::cerr << "bench: no finer run, so errors are unknown: " << reason.what() << '\n';
    return nullptr;
  }
}

struct Measured {
  std::vector<PointResult> points;
  std::size_t tried = 0;  // contestants, of them
  std::size_t all = 0;
  double seconds = 0;
};

std::vector<PointResult*> candidates(std::vector<PointResult>& points, const Wish& wish) {
  std::vector<PointResult*> list;
  for (PointResult& point : points) {
    if (point.ok() && within_error(point.measures, wish.error)) list.push_back(&point);
  }
  std::sort(list.begin(), list.end(),
            [](const PointResult* a, const PointResult* b) { return a->seconds() < b->seconds(); });
  if (list.size() > finalists) list.resize(finalists);
  return list;
}

Measured measure(const ChooseCommand& given, const Suite& suite, const Wish& wish,
                 std::shared_ptr<ReferenceShelf> shelf) {
  Measured measured;
  const auto begin = Clock::now();
  const auto searches = plan(suite, {});
  measured.all = searches.size();
  SweepEvents events;
  events.point = [&](const PointResult& point, std::size_t search, std::size_t all) {
    measured.tried = search + 1;
    std::cerr << '[' << search + 1 << '/' << all << "] " << point.spec.name() << " at "
              << step_text(point.spec.step) << " s: "
              << (point.ok() ? duration_text(point.seconds()) + " a simulated second"
                             : to_string(point.status))
              << '\n';
  };
  events.interrupted = [&] { return interrupted() || since(begin) > search_share * given.seconds; };
  SweepRunners runners;
  runners.references = std::move(shelf);
  runners = isolated(runners, 0);
  measured.points = run_sweep(suite, searches, events, runners).points;
  for (int sample = 1; sample < final_samples && since(begin) < given.seconds; ++sample) {
    for (PointResult* point : candidates(measured.points, wish)) {
      if (interrupted()) throw Interrupted();
      runners.repeat(*point, {suite.timeout, 1e300, interrupted, nullptr});
    }
  }
  measured.seconds = since(begin);
  return measured;
}

std::string error_text(double error) {
  return std::isnan(error) ? "error unknown" : "error " + analysis::percent(error);
}

std::string pick_text(const Pick& pick, double rate) {
  const PointSpec& spec = pick.point->spec;
  const auto ms = [](double seconds) { return number_text(1e3 * seconds, 3); };
  return spec.name() + " at " + step_text(spec.step) + " s (" +
         std::to_string(std::lround(1 / (rate * spec.step))) +
         " a frame): " + ms(pick.frame.median) + " ms a frame, 99 % below " + ms(pick.frame.slow) +
         ", worst " + ms(pick.frame.worst) + "; strain " +
         analysis::percent(pick.point->measures.max_strain) + ", " + error_text(pick.error);
}

json pick_json(const std::optional<Pick>& pick) {
  if (!pick) return nullptr;
  const PointSpec& spec = pick->point->spec;
  return {
      {"solver", spec.solver},
      {"settings", to_json(spec.settings)},
      {"step", spec.step},
      {"frame_seconds",
       {{"median", pick->frame.median}, {"p99", pick->frame.slow}, {"worst", pick->frame.worst}}},
      {"seconds_per_simulated_second", pick->point->seconds()},
      {"max_strain", number(pick->point->measures.max_strain)},
      {"error", number(pick->error)}};
}

// What was found, for one wish.
struct Answer {
  std::optional<Pick> take, next, half, twice;
  double budget =
      0;  // s of computation a frame; half and twice are of half of it and twice as much
};

Answer answer_of(const std::vector<PointResult>& points, const Wish& wish, double wanted_budget) {
  Answer answer;
  answer.take = fastest(points, wish);
  if (answer.take) answer.next = fastest(points, wish, answer.take->point->spec.name());
  answer.budget = wanted_budget > 0 ? wanted_budget : answer.take ? answer.take->frame.slow : 0;
  answer.half = most_accurate(points, wish, answer.budget / 2);
  answer.twice = most_accurate(points, wish, answer.budget * 2);
  return answer;
}

json answer_json(const Answer& answer, const SweepSpec& sweep, const Wish& wish) {
  return {{"scene", sweep.scene},
          {"scene_parameters", sweep.scene_parameters},
          {"strain_limit", sweep.limits.front()},
          {"error", number(wish.error)},
          {"frame", 1 / wish.rate},
          {"budget", answer.budget},
          {"take", pick_json(answer.take)},
          {"runner_up", pick_json(answer.next)},
          {"half_budget", pick_json(answer.half)},
          {"double_budget", pick_json(answer.twice)}};
}

void print_scene(std::ostream& out, const SweepSpec& sweep, const Wish& wish,
                 const Measured& measured) {
  out << analysis::scene_words(sweep.scene) << ", " << measured.points.front().spec.vertices
      << " vertices, " << analysis::percent(sweep.limits.front()) << " strain, "
      << (std::isfinite(wish.error) ? "right to " + analysis::percent(wish.error)
                                    : std::string("any motion"))
      << ": " << measured.tried << " of " << measured.all << " solvers tried in "
      << duration_text(measured.seconds) << '\n';
}

void print_answer(std::ostream& out, const Answer& answer, const Wish& wish, bool budget_given) {
  const auto& [take, next, half, twice, budget] = answer;
  if (!take) {
    out << "no solver meets limit and error in this time: give more --seconds, or a larger "
           "--error\n";
    return;
  }
  out << "take  " << pick_text(*take, wish.rate) << '\n';
  if (next) {
    const Ratio ratio = ratio_of_times(next->point->samples, take->point->samples);
    out << "next  " << pick_text(*next, wish.rate) << "; "
        << (ratio.above(1) ? analysis::text(ratio) + " times as long" : "too close to tell")
        << '\n';
  }
  const auto told = [](const std::optional<Pick>& pick) {
    return pick ? pick->point->spec.name() + " at " + step_text(pick->point->spec.step) + " s, " +
                      error_text(pick->error)
                : std::string("no solver meets the limit");
  };
  out << "with  " << number_text(500 * budget, 3) << " ms a frame: " << told(half) << "; with "
      << number_text(2000 * budget, 3) << " ms: " << told(twice) << '\n';
  if (budget_given && take->frame.slow > budget)
    out << "1 % of frames take longer than the budget of " << number_text(1e3 * budget, 3)
        << " ms\n";
}

int choose(const ChooseCommand& given) {
  check_rate(given.frames_per_second);
  Wish wish{given.error, given.frames_per_second};
  const double budget = given.budget.empty() ? 0 : duration_of("--budget", given.budget);
  const Suite suite = suite_of(given, wish.rate);
  const SweepSpec& sweep = suite.sweeps.front();
  if (sweep.contestants.empty()) check_solver_pattern(given.solver);
  catch_interrupts();
  const TimingLock lock(!given.no_wait);
  const auto shelf = std::make_shared<ReferenceShelf>(source_path("results/references"));
  const auto reference = reference_for(sweep, *shelf);
  if (!reference) wish.error = any_motion;
  const Measured measured = measure(given, suite, wish, shelf);
  const Answer answer = answer_of(measured.points, wish, budget);
  if (given.as_json) {
    json document = answer_json(answer, sweep, wish);
    document["reference"] = reference ? json(reference->method) : json();
    document["measured_seconds"] = measured.seconds;
    std::cout << document.dump(1) << '\n';
  } else {
    print_scene(std::cout, sweep, wish, measured);
    print_answer(std::cout, answer, wish, budget > 0);
  }
  return answer.take ? success : cannot_decide;
}

}  // namespace

Verb choose_verb() {
  return {
      "choose", "recommend a solver and a step for a scene, after a minute of measuring",
      [](const Command& command) -> Action {
        const auto given = std::make_shared<ChooseCommand>();
        given->scene = "drape";
        add_scene(command, *given, given->scene);
        add_limits(command, given->limits, given->limits);
        command
            .option("--error", given->error,
                    "permitted distance from the reference, over the scene's size; default: 0.02",
                    "E")
            .positive();
        command.option("--fps", given->frames_per_second,
                       "frames a second: 24, 30 or 60 (default); no step is longer than a frame",
                       "N");
        command.option("--budget", given->budget, "computing time that a frame may take, e.g. 2ms",
                       "TIME");
        add_solver(command, given->solver);
        command.option("--seconds", given->seconds, "that measuring may take; default: 60", "S")
            .positive();
        command.flag("--json", given->as_json, "for programs");
        add_no_wait(command, given->no_wait);
        return [given] { return choose(*given); };
      }};
}

}  // namespace harness
