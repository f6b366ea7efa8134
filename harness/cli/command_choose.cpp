// bench choose: which solver to take for a scene, at which step, and what a frame costs.
#include <set>

#include "harness/analysis/measured_point.h"
#include "harness/base/child_process.h"
#include "harness/base/timing_lock.h"
#include "harness/cli/command.h"
#include "harness/judge/reference_routes.h"
#include "harness/points/tuned.h"
#include "harness/run/choose.h"

namespace harness {
namespace {

using analysis::percent;

std::string ms(double seconds) { return number_text(1e3 * seconds, 3); }

struct Choice {
  const SweepSpec& sweep;
  Wish wish;
  const Trials& trials;
  double seconds;  // elapsed
  Recommendation found = recommend(trials.points, wish);

  std::string text(const Pick& pick) const {
    const PointSpec& spec = pick.point->spec;
    return spec.contestant + " at " + step_text(spec.step) + " s (" +
           std::to_string(std::lround(1 / (wish.rate * spec.step))) +
           " a frame): " + ms(pick.frame.median) + " ms a frame, 99 % below " +
           ms(pick.frame.slow) + ", worst " + ms(pick.frame.worst) + "; strain " +
           percent(pick.point->measures.max_strain) + ", error " +
           (std::isnan(pick.error) ? "unknown" : percent(pick.error));
  }

  const char* nothing_found() const {
    if (trials.complete)
      return "no solver meets limit and error: a larger --error or --limit may be met\n";
    return std::ranges::any_of(trials.points, &PointResult::ok)
               ? "no run that ended in this time meets limit and error: give more --seconds, or a "
                 "larger --error\n"
               : "no run ended within its strain limit in this time: give more --seconds, or a "
                 "smaller --n\n";
  }

  void print_found(std::ostream& out) const {
    const std::string given = "the budget of " + ms(wish.budget) + " ms";
    if (!found.to_be_taken())
      out << "no solver that was tried keeps " << given
          << "; the fastest within limit and error:\n";
    out << (found.to_be_taken() ? "take  " : "best  ") << text(*found.best) << '\n';
    if (found.budget == Kept::half)
      out << "1 % of its frames or more take longer than " << given << '\n';
    if (found.next) {
      const Ratio ratio = ratio_of_times(found.next->point->samples, found.best->point->samples);
      out << "next  " << text(*found.next) << "; "
          << (ratio.above(1)   ? analysis::text(ratio) + " times as long"
              : ratio.below(1) ? "faster, with slower frames"
                               : "too close to rank")
          << '\n';
    }
  }

  void print(std::ostream& out) const {
    std::set<std::string> tried;
    for (const PointResult& point : trials.points) tried.insert(point.spec.contestant);
    out << analysis::scene_words(sweep.scene) << ", " << trials.screened.front().spec.vertices
        << " vertices, " << percent(sweep.limits.front()) << " strain, "
        << (std::isfinite(wish.error) ? "motion error at most " + percent(wish.error)
                                      : std::string("any motion"))
        << ": " << tried.size() << " of " << trials.screened.size() << " solvers tried in "
        << duration_text(seconds);
    if (std::ranges::none_of(trials.points, &PointResult::ok)) {
      out << ": " << nothing_found();
      return;
    }
    out << '\n';
    if (found.best)
      print_found(out);
    else
      out << nothing_found();
    for (const PointResult& screened : trials.screened) {
      const std::string& name = screened.spec.contestant;
      if (const std::string why = why_not(name, trials, wish); !why.empty())
        out << "not   " << name << ": " << why << '\n';
    }
  }
};

constexpr double far_behind = 4;         // times the fastest run so far: slower runs are stopped
constexpr int finest_part = 32;          // the smallest step is this part of a frame
constexpr double reference_share = 0.4;  // at most, of --seconds

// The contestants that --solver matches, and solvers named in full. Throws UsageError if none.
Contestants contestants_for(const std::string& given, const SceneType& type,
                            const SceneParameters& parameters) {
  Contestants all = competitors(type, parameters);
  if (given.empty()) return all;
  const auto wanted = solver_pattern(given);
  std::erase_if(all, [&](const Contestant& c) { return !wanted->matches(c.name); });
  for (const std::string& name : alternatives(given))
    if (find_backend(name) && find_contestant(all, name) == all.end()) all.push_back({name, name});
  if (all.empty())
    throw UsageError("no solver that --solver '" + shortened(given) + "' matches competes on " +
                     type.name + "; one that is named in full is tried there");
  return all;
}

// A stored reference, or else a quick one, which is added to `references`. Null: neither.
std::shared_ptr<const Reference> reference_for(const SweepSpec& sweep, ReferenceFolder& references,
                                               const ChooseLimits& limits) {
  if (auto kept = references.find(sweep.scene, sweep.scene_parameters)) return kept;
  std::cerr << "this scene has no reference: making a quick one ...\n";
  const auto stop = [&limits] {
    return limits.interrupted() || limits.elapsed() > reference_share * limits.seconds;
  };
  const auto compute = [&sweep](Heartbeat&) {
    RouteRuns runs([](const std::string& line) { std::cerr << line << std::endl; });
    return to_json(compute_reference(sweep.scene, sweep.scene_parameters, quick_finest, runs));
  };
  std::string reason;
  try {
    auto made = in_child(
        {.timeout = limits.seconds, .interrupted = stop}, compute,
        [](const json& document) {
          return std::make_shared<const Reference>(reference_of(document, "the quick reference"));
        },
        [&reason](const ChildOutcome& child) {
          reason = ending(child);
          return std::shared_ptr<const Reference>();
        });
    if (made) {
      references.put(made);
      std::cerr << reference_text(*made) << '\n';
      return made;
    }
  } catch (const Interrupted&) {
    if (limits.interrupted()) throw;
    reason = "it takes more than " + number_text(100 * reference_share) + " % of --seconds " +
             number_text(limits.seconds);
  }
  std::cerr << "bench: no reference, so errors are unknown: " << reason << '\n';
  return nullptr;
}

Trials measure(const Suite& suite, const Wish& wish, const ChooseLimits& limits,
               std::shared_ptr<ReferenceFolder> references) {
  SweepEvents events;
  events.point = [](const PointResult& point, std::size_t search, std::size_t all) {
    std::cerr << '[' << search + 1 << '/' << all << "] " << point.spec.contestant << " at "
              << step_text(point.spec.step) << " s: "
              << (point.ok() ? duration_text(point.seconds()) + " a simulated second"
                             : to_string(point.status))
              << std::endl;
  };
  return try_contestants(suite, plan(suite, {}), wish, limits, events,
                         with_references(isolated(run_point, 0), std::move(references)));
}

struct Choose : SceneOptions {
  std::string solver;
  double limit = 0.01, seconds = 60, budget = 0;  // budget: ms
  Wish wish;
  bool no_wait = false;

  void declare(const Command& command) {
    scene = "drape";
    SceneOptions::declare(command, scene);
    command.option("--limit", limit, "strain limit; default: 0.01", "STRAIN", Bounds::strain());
    command.option("--error", wish.error,
                   "permitted distance from the reference, over the scene's size; default: 0.02",
                   "E", Bounds::positive());
    command.option("--fps", wish.rate,
                   "frames a second: 24, 30 or 60 (default); no step is longer than a frame", "N");
    command.option("--budget", budget, "milliseconds of computing that a frame may take", "MS",
                   Bounds::positive());
    add_solver(command, solver);
    command.option("--seconds", seconds, "time that measuring may take; default: 60", "S",
                   Bounds::positive());
    add_no_wait(command, no_wait);
  }

  Suite suite() const {
    const auto type = find_scene(name());
    Suite chosen;
    chosen.name = "choose";
    chosen.reps = 1;
    chosen.finest_error = std::min(wish.error, headline_error);
    chosen.timeout = seconds;
    chosen.far_behind = far_behind * std::max(1.0, headline_error / wish.error);
    SweepSpec& sweep = chosen.sweeps.emplace_back();
    sweep.sweep = "strain";
    sweep.refine = false;  // the time is better spent on other contestants
    sweep.scene = name();
    sweep.limits = {limit};
    sweep.scene_parameters = complete_parameters();
    sweep.resolutions = {static_cast<int>(sweep.scene_parameters.at(type->resolution))};
    sweep.coarsest = 1 / wish.rate;
    sweep.finest = sweep.coarsest / finest_part;
    sweep.contestants = contestants_for(solver, *type, sweep.scene_parameters);
    tune(sweep.contestants, read_tuned_up_to_date("tuned.json"), type->kind());
    return chosen;
  }

  int run() {
    if (std::ranges::count(frame_rates, wish.rate) == 0)
      throw UsageError("--fps is " + number_text(wish.rate) + ", must be 24, 30 or 60");
    wish.budget = 1e-3 * budget;
    const Suite tried = suite();
    const TimingLock lock(!no_wait);
    const auto begin = Clock::now();
    const ChooseLimits limits_of_time{seconds, [begin] { return since(begin); }, interrupted};
    const auto references = ReferenceFolder::usual();
    const auto reference = reference_for(tried.sweeps.front(), *references, limits_of_time);
    if (!reference) wish.error = any_motion;
    const Trials trials = measure(tried, wish, limits_of_time, references);
    const Choice choice{tried.sweeps.front(), wish, trials, since(begin)};
    choice.print(std::cout);
    return choice.found.all_is_well() ? success : cannot_decide;
  }
};

}  // namespace

Action choose_verb(const Command& command) { return verb<Choose>(command); }

}  // namespace harness
