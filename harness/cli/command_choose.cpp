// bench choose: which solver to take for a scene, at which step, and what a frame costs.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "harness/analysis/words.h"
#include "harness/base/clock.h"
#include "harness/base/errors.h"
#include "harness/base/interrupt.h"
#include "harness/base/paths.h"
#include "harness/base/text.h"
#include "harness/base/timing_lock.h"
#include "harness/cli/commands.h"
#include "harness/cli/sweep_options.h"
#include "harness/judge/reference_routes.h"
#include "harness/points/point_json.h"
#include "harness/points/tuning_rule.h"
#include "harness/run/choose.h"
#include "harness/run/frame_times.h"
#include "harness/run/isolation.h"

namespace harness {
namespace {

using nlohmann::json;

constexpr double far_behind = 4;       // times the fastest so far: who takes longer is stopped
constexpr int finest_part = 32;        // of a frame: the smallest step
constexpr int finalists = 4;           // that are timed again, in turn
constexpr int final_samples = 7;       // of each
constexpr double search_share = 0.75;  // of the time; the rest is for finalists

struct ChooseCommand {
  std::string scene = "drape", n, frame = "1/60", budget, solver;
  SceneWords words;
  double limit = 0.01, error = headline_error, seconds = 60;
  bool as_json = false, no_wait = false;
};

// "1/60", or a number.
double fraction_of(const std::string& option, const std::string& text) {
  const auto slash = text.find('/');
  const auto number = [&](const std::string& part) {
    char* end = nullptr;
    const double value = std::strtod(part.c_str(), &end);
    if (part.empty() || *end != '\0' || !(value > 0))
      throw UsageError(option + " is '" + shortened(text, 40) + "', must be seconds, such as 1/60");
    return value;
  };
  if (slash == std::string::npos) return number(text);
  return number(text.substr(0, slash)) / number(text.substr(slash + 1));
}

// "2ms", "500us", "0.002s".
double duration_of(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  const double scale = unit == "ms" ? 1e-3 : unit == "us" ? 1e-6 : unit == "s" ? 1 : 0;
  if (!(value > 0) || scale == 0)
    throw UsageError(option + " is '" + shortened(text, 40) +
                     "', must be such as 2ms, 500us or 0.002s");
  return value * scale;
}

double rate_of(const std::string& frame) {
  const double rate = 1 / fraction_of("--frame", frame);
  for (const double known : frame_rates) {
    if (std::abs(rate - known) < 1e-3 * known) return known;
  }
  throw UsageError("--frame is '" + shortened(frame, 40) + "', must be 1/24, 1/30 or 1/60");
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
  const std::string scene = scene_of(given.scene, given.words);
  const auto type = find_scene(scene);
  if (!type) throw unknown_name("scene", scene, names_of(scene_types()));
  SceneParameters parameters = parameters_of(given.words);
  if (!given.n.empty()) {
    const std::vector<double> sizes = numbers_of("--n", given.n, Bounds::whole_number(2));
    if (sizes.size() != 1) throw UsageError("--n: one size");
    parameters[type->resolution] = sizes.front();
  }
  Suite suite;
  suite.name = "choose";
  suite.reps = 1;
  suite.finest_error = std::min(given.error, headline_error);
  suite.timeout = given.seconds;
  suite.far_behind = far_behind;
  SweepSpec& sweep = suite.sweeps.emplace_back();
  sweep.sweep = "strain";
  sweep.scene = scene;
  sweep.limits = {given.limit};
  sweep.scene_parameters = complete_parameters(*type, parameters);
  sweep.resolutions = {static_cast<int>(sweep.scene_parameters.at(type->resolution))};
  sweep.coarsest = 1 / rate;
  sweep.finest = sweep.coarsest / finest_part;
  const Pattern wanted("--solver", given.solver.empty() ? ".*" : given.solver);
  for (const auto& backend : inextensible::backends()) {
    if (competes(backend, type->kind() == "chain") && wanted.matches(backend.name))
      sweep.contestants.push_back({backend.name, backend.name});
  }
  const Tuned tuned = read_tuned_up_to_date("tuned.json");
  tune(sweep.contestants, tuned, type->kind(), {}, Untuned::none);
  std::stable_sort(sweep.contestants.begin(), sweep.contestants.end(),
                   [&](const Contestant& a, const Contestant& b) {
                     return recorded_seconds(tuned, type->kind(), a.solver, given.limit) <
                            recorded_seconds(tuned, type->kind(), b.solver, given.limit);
                   });
  return suite;
}

// A kept reference, or a finer run made now, which is on the shelf then.
std::shared_ptr<const Reference> reference_for(const SweepSpec& sweep, ReferenceShelf& shelf) {
  if (auto kept = shelf.find(sweep.scene, sweep.scene_parameters)) return kept;
  std::cerr << "no reference of this scene is kept: a finer run takes its place ...\n";
  try {
    auto made = std::make_shared<const Reference>(
        finer_run(sweep.scene, sweep.scene_parameters, [](const std::string& line) {
          if (interrupted()) throw Interrupted();
          std::cerr << line << '\n';
        }));
    shelf.put(made);
    return made;
  } catch (const UsageError& reason) {
    std::cerr << "bench: there is none, so nothing is known of errors: " << reason.what() << '\n';
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

int choose(const ChooseCommand& given) {
  const double rate = rate_of(given.frame);
  const double wanted_budget = given.budget.empty() ? 0 : duration_of("--budget", given.budget);
  const Suite suite = suite_of(given, rate);
  const SweepSpec& sweep = suite.sweeps.front();
  if (sweep.contestants.empty()) check_solver_pattern(given.solver);
  Wish wish{given.error, rate};
  catch_interrupts();
  const TimingLock lock(!given.no_wait);
  auto shelf = std::make_shared<ReferenceShelf>(source_path("results/references"));
  const auto reference = reference_for(sweep, *shelf);
  if (!reference) wish.error = any_motion;
  const Measured measured = measure(given, suite, wish, shelf);
  const auto take = fastest(measured.points, wish);
  const double budget = wanted_budget > 0 ? wanted_budget : take ? take->frame.slow : 0;
  const auto next = take ? fastest(measured.points, wish, take->point->spec.name()) : std::nullopt;
  const auto half = most_accurate(measured.points, wish, budget / 2);
  const auto twice = most_accurate(measured.points, wish, budget * 2);
  if (given.as_json) {
    std::cout << json{{"scene", sweep.scene},
                      {"scene_parameters", sweep.scene_parameters},
                      {"strain_limit", given.limit},
                      {"error", number(wish.error)},
                      {"frame", 1 / rate},
                      {"budget", budget},
                      {"reference", reference ? json(reference->method) : json()},
                      {"measured_seconds", measured.seconds},
                      {"take", pick_json(take)},
                      {"runner_up", pick_json(next)},
                      {"half_budget", pick_json(half)},
                      {"double_budget", pick_json(twice)}}
                     .dump(1)
              << '\n';
    return take ? success : cannot_decide;
  }
  std::cout << sweep.scene << ", " << measured.points.front().spec.vertices << " vertices, "
            << analysis::percent(given.limit) << " strain, "
            << (std::isfinite(wish.error) ? "right to " + analysis::percent(wish.error)
                                          : std::string("any motion"))
            << ": " << measured.tried << " of " << measured.all << " solvers tried in "
            << duration_text(measured.seconds) << '\n';
  if (!take) {
    std::cout << "none keeps both in this time; more --seconds, or a larger --error\n";
    return cannot_decide;
  }
  std::cout << "take  " << pick_text(*take, rate) << '\n';
  if (next) {
    const Ratio ratio = ratio_of_times(next->point->samples, take->point->samples);
    std::cout << "next  " << pick_text(*next, rate) << "; "
              << (ratio.above(1) ? analysis::text(ratio) + " times as long" : "too close to tell")
              << '\n';
  }
  const auto told = [&](const std::optional<Pick>& pick) {
    return pick ? pick->point->spec.name() + " at " + step_text(pick->point->spec.step) + " s, " +
                      error_text(pick->error)
                : std::string("nothing that keeps the limit");
  };
  std::cout << "with  " << number_text(500 * budget, 3) << " ms a frame: " << told(half)
            << "; with " << number_text(2000 * budget, 3) << " ms: " << told(twice) << '\n';
  if (wanted_budget > 0 && take->frame.slow > budget)
    std::cout << "1 % of frames take longer than the budget of " << number_text(1e3 * budget, 3)
              << " ms\n";
  return success;
}

}  // namespace

void add_choose_command(const Command& program) {
  const auto given = std::make_shared<ChooseCommand>();
  const Command command = program.subcommand(
      "choose",
      "which solver to take for a scene: measures for a minute, and says it in three lines");
  command.option("--scene", given->scene, "which (bench list scenes), or mesh:FILE.obj", "SCENE");
  add_scene_words(command, given->words);
  command.option("--n", given->n, "the scene's size", "N");
  command.option("--limit", given->limit, "permitted strain, default 0.01", "STRAIN")
      .holds(Bounds::strain());
  command
      .option("--error", given->error,
              "permitted distance from the right motion, over the scene's size, default 0.02", "E")
      .positive();
  command.option("--frame", given->frame, "1/24, 1/30 or 1/60 s; no step is longer", "S");
  command.option("--budget", given->budget, "computation that a frame may take, e.g. 2ms", "TIME");
  command.alternatives("--solver", given->solver, "only solvers whose name matches");
  command.option("--seconds", given->seconds, "that measuring may take, default 60", "S")
      .positive();
  command.flag("--json", given->as_json, "for programs");
  add_no_wait(command, given->no_wait);
  command.does([given] { return choose(*given); });
}

}  // namespace harness
