// bench choose: which solver to take for a scene, at which step, and what a frame costs.
#include <algorithm>
#include <iostream>

#include "harness/base/child_process.h"
#include "harness/base/clock.h"
#include "harness/base/errors.h"
#include "harness/base/interrupt.h"
#include "harness/base/json_text.h"
#include "harness/base/paths.h"
#include "harness/base/text.h"
#include "harness/base/timing_lock.h"
#include "harness/cli/choice_report.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/shared_options.h"
#include "harness/cli/verbs.h"
#include "harness/judge/reference_file.h"
#include "harness/judge/reference_routes.h"
#include "harness/points/tuned.h"
#include "harness/run/choose.h"
#include "harness/run/frame_times.h"
#include "harness/run/isolation.h"

namespace harness {
namespace {

using nlohmann::json;

constexpr double far_behind = 4;  // times the fastest so far: a run that takes longer is stopped
constexpr int finest_part = 32;   // of a frame: the smallest step
constexpr double reference_share = 0.4;  // of the time, for a finer run at most

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

// Contestants of the scene that --solver matches, and what it names that does not compete there.
// Throws UsageError for a name that the scene has nothing for.
Contestants contestants_for(const std::string& given, const SceneType& type,
                            const SceneParameters& parameters) {
  Contestants all = competitors(type, parameters);
  if (given.empty()) return all;
  check_solver_pattern(given);
  const Pattern wanted("--solver", given);
  std::erase_if(all, [&](const Contestant& c) { return !wanted.matches(c.name); });
  for (const std::string& name : alternatives(given)) {
    if (inextensible::find_backend(name) && find_contestant(all, name) == all.end())
      all.push_back({name, name});
  }
  if (all.empty())
    throw UsageError("no solver that --solver '" + shortened(given) + "' matches competes on " +
                     type.name + "; one that is named in full is tried there");
  return all;
}

Suite suite_of(const ChooseCommand& given, double rate) {
  const SceneParameters parameters = complete_parameters_of(given);
  const std::string scene = scene_of(given);
  const auto type = find_scene(scene);
  Suite suite;
  suite.name = "choose";
  suite.reps = 1;
  suite.finest_error = std::min(given.error, headline_error);
  suite.timeout = given.seconds;
  suite.far_behind = far_behind * std::max(1.0, headline_error / given.error);
  SweepSpec& sweep = suite.sweeps.emplace_back();
  sweep.sweep = "strain";
  sweep.refine = false;  // the time is better spent on other contestants
  sweep.scene = scene;
  sweep.limits = {limit_of(given)};
  sweep.scene_parameters = parameters;
  sweep.resolutions = {static_cast<int>(sweep.scene_parameters.at(type->resolution))};
  sweep.coarsest = 1 / rate;
  sweep.finest = sweep.coarsest / finest_part;
  sweep.contestants = contestants_for(given.solver, *type, parameters);
  tune(sweep.contestants, read_tuned_up_to_date("tuned.json"), type->kind(), {}, false);
  return suite;
}

// A kept reference, or a finer run made now, which is then among `references`. Null: neither.
std::shared_ptr<const Reference> reference_for(const SweepSpec& sweep, ReferenceFolder& references,
                                               const ChooseLimits& limits) {
  if (auto kept = references.find(sweep.scene, sweep.scene_parameters)) return kept;
  std::cerr << "this scene has no reference: making a finer run in its place ...\n";
  const auto stop = [&limits] {
    return limits.interrupted() || limits.elapsed() > reference_share * limits.seconds;
  };
  ChildOutcome outcome = run_in_child(
      [&sweep](Heartbeat&) {
        const auto tell = [](const std::string& line) { std::cerr << line << std::endl; };
        return compact(to_json(finer_run(sweep.scene, sweep.scene_parameters, tell)));
      },
      {.timeout = limits.seconds, .interrupted = stop});
  if (limits.interrupted()) throw Interrupted();
  if (const auto made = answer(outcome, [](const json& document) {
        return std::make_shared<const Reference>(reference_of(document, "the finer run"));
      })) {
    references.put(*made);
    return *made;
  }
  std::cerr << "bench: no finer run, so errors are unknown: "
            << (outcome.end == ChildOutcome::End::interrupted
                    ? "it takes more than " + number_text(100 * reference_share) +
                          " % of --seconds " + number_text(limits.seconds)
                    : ending(outcome))
            << '\n';
  return nullptr;
}

Trials measure(const Suite& suite, const Wish& wish, const ChooseLimits& limits,
               std::shared_ptr<ReferenceFolder> references) {
  SweepEvents events;
  events.point = [](const PointResult& point, std::size_t search, std::size_t all) {
    std::cerr << '[' << search + 1 << '/' << all << "] " << point.spec.name() << " at "
              << step_text(point.spec.step) << " s: "
              << (point.ok() ? duration_text(point.seconds()) + " a simulated second"
                             : to_string(point.status))
              << std::endl;
  };
  SweepRunners inner;
  inner.references = std::move(references);
  ChooseRunners runners{isolated(inner, 0), {}};
  inner.run = screen_point;
  runners.screen = isolated(inner, 0).run;
  return try_contestants(suite, plan(suite, {}), wish, limits, events, runners);
}

int choose(const ChooseCommand& given) {
  check_rate(given.frames_per_second);
  Wish wish{given.error, given.frames_per_second,
            given.budget.empty() ? 0 : duration_of("--budget", given.budget)};
  const Suite suite = suite_of(given, wish.rate);
  const SweepSpec& sweep = suite.sweeps.front();
  const TimingLock lock(!given.no_wait);
  const auto begin = Clock::now();
  const ChooseLimits limits{given.seconds, [begin] { return since(begin); }, interrupted};
  const auto references = std::make_shared<ReferenceFolder>(source_path("results/references"));
  const auto reference = reference_for(sweep, *references, limits);
  if (!reference) wish.error = any_motion;
  const Trials trials = measure(suite, wish, limits, references);
  const ChoiceReport report{sweep, wish, trials, since(begin), reference ? reference->method : ""};
  if (given.as_json) {
    std::cout << to_json(report).dump(1) << '\n';
  } else {
    print(std::cout, report);
  }
  return recommend(trials.points, wish).all_is_well() ? success : cannot_decide;
}

int choose_or_tell_interrupted(const ChooseCommand& given) {
  catch_interrupts();
  try {
    return choose(given);
  } catch (const Interrupted&) {
    std::cerr << "bench: interrupted, nothing is recommended\n";
    return interrupted_exit;
  }
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
        return [given] { return choose_or_tell_interrupted(*given); };
      }};
}

}  // namespace harness
