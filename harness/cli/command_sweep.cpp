// bench --sweep strain|resolution|step|stability, and the sweeps of a suite.
#include <sstream>

#include "harness/base/small_runs.h"
#include "harness/base/standard_streams.h"
#include "harness/base/text.h"
#include "harness/base/timing_lock.h"
#include "harness/cli/command.h"
#include "harness/judge/reference.h"
#include "harness/judge/reference_routes.h"
#include "harness/points/context.h"
#include "harness/points/result_file.h"
#include "harness/run/execute.h"
#include "harness/run/machine_noise.h"
#include "harness/run/sweep.h"
#include "harness/stability/stability.h"
#include "harness/tables/tables.h"

namespace harness {
namespace {

struct SweepCommand : SweepOptions, OutputOptions {
  std::string shard;
  double memory = 0;  // bytes; 0: no limit
  bool dry_run = false, no_wait = false;
  std::string hard_case;  // of --sweep stability

  void declare(const Command& command);
  int run(const Words& typed);

 private:
  Command of_suites_, of_cases_;  // options that only one kind of sweep has
};

// ---- Sweeps of a suite ----

int dry_run(const Suite& suite, const std::vector<Search>& searches) {
  std::size_t most = 0;
  for (const Search& search : searches) most += search.ladder.size();
  const Estimate guess = estimate(suite, searches);
  std::cout << searches.size() << " searches for a best step, at most " << most
            << " points (usually half of them), about " << duration_text(guess.seconds)
            << ", estimated from a few steps of " << guess.timed << " contestants and sizes\n";
  return success;
}

// Larger scenes than any that has a reference: even a few steps of a slow route take long.
constexpr int most_timed_vertices = 20000;

void report_missing_references(const SweepCommand& options, const std::vector<Search>& searches,
                               ReferenceFolder& references) {
  const auto missing = without_reference(searches, references);
  if (missing.empty()) return;
  std::string names;
  double seconds = 0;
  for (const auto& [file, scene] : missing) {
    names += (names.empty() ? "" : ", ") + file.substr(0, file.rfind(".json"));
    if (find_scene(scene.first)->counts(scene.second).first <= most_timed_vertices)
      seconds += reference_seconds(scene.first, scene.second);
  }
  if (options.finest_error > 0)
    throw UsageError("--finest-error needs references, missing: " + names +
                     " (bench reference, with the same scene and profile, makes them)");
  std::cerr << "bench: no reference, so no trajectory error, for " << names
            << " (bench reference makes them, in about " << duration_text(seconds) << ")\n";
}

// What chooses points beside the suite.
nlohmann::json selection(const SweepCommand& options) {
  nlohmann::json chosen = {{"solver", options.solver},
                           {"filter", options.filter},
                           {"exclude", options.exclude},
                           {"shard", options.shard}};
  if (options.untimed) chosen["untimed"] = true;  // no part of it may be taken up as timed
  return chosen;
}

// Runs that look at the machine between them, and take disturbed samples again while the budget
// lasts.
SweepRunners watched(const SweepRunners& inner, NoiseProbe& noise_probe, bool timed) {
  const auto budget = std::make_shared<RetakeBudget>();
  return wrapped(inner,
                 [timed, budget, &noise_probe](const auto&, RunLimits limits, const auto& call) {
                   limits.timed = timed;
                   limits.most_retaken = budget->most();
                   noise_probe.sample_if_due();
                   auto result = call(limits);
                   budget->add(result.samples.size(), result.retaken);
                   return result;
                 });
}

void warn_if_busy(const nlohmann::json& context) {
  const auto& load = context.at("load_avg");
  const double processors = context.at("num_cpus");
  if (!load.empty() && load.at(0).get<double>() > 0.5 * processors)
    std::cerr << "bench: the machine is busy (load " << number_text(load.at(0), 2) << " on "
              << processors << " processors): times will be noisy\n";
}

SweepEvents shown(Progress& progress) {
  SweepEvents events;
  events.interrupted = interrupted;
  events.point = [&progress, points = 0](const PointResult& p, std::size_t s,
                                         std::size_t all) mutable {
    progress.show(
        (static_cast<double>(s) + 0.5) / static_cast<double>(all),
        std::to_string(++points) + " points",
        p.spec.id() + " " + (p.ok() ? duration_text(p.seconds()) + "/s" : to_string(p.status)));
  };
  events.repetition = [&progress, first = true](std::size_t done, std::size_t all) mutable {
    if (std::exchange(first, false)) progress.begin_part();
    progress.show(done, all, "re-timing the best runs");
  };
  return events;
}

// Runs the sweep, with progress on stderr and each run in the journal, and writes into the context
// how quiet the machine was.
SweepOutcome measured(const Suite& suite, const std::vector<Search>& searches,
                      const SweepRunners& runners, Journal& journal, bool timed,
                      nlohmann::json& context) {
  Progress progress;
  NoiseProbe noise_probe;
  noise_probe.sample();
  SweepOutcome outcome = run_sweep(suite, searches, shown(progress),
                                   journaled(watched(runners, noise_probe, timed), journal));
  noise_probe.sample();
  context["sentinel"] = noise_probe.to_json();
  return outcome;
}

nlohmann::json context_of(const SweepCommand& options) {
  nlohmann::json context = machine_context();
  context["selection"] = selection(options);
  return context;
}

int run_suite(const SweepCommand& options, const Words& typed) {
  const Suite suite = load_suite(options);
  auto searches = plan(suite, filters_of(options));
  if (!options.shard.empty()) searches = shard(std::move(searches), parse_shard(options.shard));
  if (options.dry_run) return dry_run(suite, searches);
  nlohmann::json context = context_of(options);
  const auto run = [&](const std::string& out, Journal& journal,
                       const nlohmann::json& before) -> Finished {
    if (options.rerun_failed) forget_failures(journal);
    SweepRunners runners;
    const auto references = ReferenceFolder::usual();
    runners.references = references;
    report_missing_references(options, searches, *references);
    std::optional<TimingLock> lock;
    if (!options.untimed) lock.emplace(!options.no_wait);
    if (lock && lock->waited()) context = context_of(options);
    context["timed"] = !options.untimed;
    if (!options.untimed) warn_if_busy(context);
    if (before.is_object())
      context["resumed"] = {{"from", before.at("date")}, {"points", points_in(journal)}};
    const SweepOutcome outcome = measured(suite, searches, isolated(runners, options.memory),
                                          journal, !options.untimed, context);
    nlohmann::json document = result_document(context, suite, typed, outcome.complete,
                                              outcome.points, references->summaries());
    std::ostringstream text;
    print_sweep(text, document, out, false, output_columns());
    return {std::move(document), outcome.complete, text.str()};
  };
  OutputOptions output = options;
  output.no_plots |= options.untimed;
  return carry_out(output, {suite.name + "-" + options.sweep, context, to_json(suite), "points",
                            "points", run, add_runs_of, points_in});
}

// ---- Hard cases: they are in the program, not in a suite ----

StabilityPlan plan_of(const SweepCommand& options) {
  StabilityPlan plan = plan_stability(options.profile, solver_pattern(options.solver),
                                      pattern_of("--case", options.hard_case));
  if (!options.shard.empty()) plan.keep(parse_shard(options.shard));
  return plan;
}

int print_plan(const StabilityPlan& plan) {
  std::cout << plan.cells() << " cells: " << plan.cases.size() << " hard cases by "
            << plan.solvers.size() << " solvers; " << plan.scenes.size()
            << " scenes for each solver's largest step, " << plan.frames.size()
            << " for frames side by side\n";
  return success;
}

void add_cells_of(const nlohmann::json& result, Journal& journal) {
  for (const nlohmann::json& row : result.at("matrix"))
    journal.add(cell_key(row.at("case"), row.at("solver")), to_json(trial_result_of(row)));
}

int run_hard_cases(const SweepCommand& options, const Words& typed) {
  check_known("profile", options.profile, profiles());
  const StabilityPlan plan = plan_of(options);
  if (options.dry_run) return print_plan(plan);
  nlohmann::json context = machine_context();
  context["selection"] = {{"solver", options.solver},
                          {"case", options.hard_case},
                          {"values", hard_case_values(options.profile)},
                          {"seed", options.seed},
                          {"shard", options.shard}};
  const auto run = [&](const std::string&, Journal& journal, const nlohmann::json&) -> Finished {
    Progress progress;
    const std::uint64_t seed = options.seed < 0 ? 1 : static_cast<std::uint64_t>(options.seed);
    const StabilityOutcome outcome = run_stability(plan, seed, journaled_events(journal, progress));
    const nlohmann::json document = stability_document(context, outcome, seed, typed);
    std::ostringstream text;
    print_outcomes(text, document);
    return {document, outcome.complete, fitted(text.str(), output_columns()),
            outcome.nothing_new() ? success : unexpected_outcome};
  };
  return carry_out(
      options, {options.profile + "-stability", context, {}, "matrix", "cells", run, add_cells_of});
}

void SweepCommand::declare(const Command& command) {
  of_suites_ = command.group("with --sweep strain, resolution and step");
  of_cases_ = command.group("with --sweep stability");
  SweepOptions::declare(command, of_suites_);
  OutputOptions::declare(command, "<profile>-<axis>.json");
  command.option("--shard", shard,
                 "i/N: the i-th of N parts; all solvers of a scene and size are in one part",
                 "I/N");
  command.flag("--dry-run", dry_run, "print what would run and how long, and stop");
  add_no_wait(command, no_wait);
  of_suites_.byte_count("--memory", memory, "address space a point may have, e.g. 4G");
  of_suites_.flag("--rerun-failed", rerun_failed,
                  "as --resume, also after a finished run, and run again what failed");
  of_cases_.option("--case", hard_case, "only cases whose name contains a match, e.g. 'Q[12]'",
                   "REGEX");
}

int SweepCommand::run(const Words& typed) {
  if (sweep.empty())
    throw UsageError(
        "nothing to do: give --sweep strain, resolution, step or stability (see bench --help)");
  const bool hard_cases = sweep == "stability";
  const Command& others = hard_cases ? of_suites_ : of_cases_;
  if (const std::string name = others.one_typed(); !name.empty())
    throw UsageError(name + " goes " + others.heading() + " only" +
                     (hard_cases ? " (--case chooses hard cases)" : ""));
  return hard_cases ? run_hard_cases(*this, typed) : run_suite(*this, typed);
}

}  // namespace

Action sweep_verb(const Command& command) { return verb<SweepCommand>(command); }

}  // namespace harness
