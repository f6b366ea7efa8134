// Runs a suite's sweeps: bench --sweep strain|resolution|step.
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/paths.h"
#include "harness/base/standard_streams.h"
#include "harness/base/text.h"
#include "harness/base/timing_lock.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/figures.h"
#include "harness/cli/progress.h"
#include "harness/cli/sweep_run.h"
#include "harness/judge/reference_file.h"
#include "harness/points/context.h"
#include "harness/points/noise.h"
#include "harness/points/result_file.h"
#include "harness/run/isolation.h"
#include "harness/run/journaled.h"
#include "harness/run/measure_point.h"
#include "harness/run/noise_probe.h"
#include "harness/run/plan.h"
#include "harness/run/quiet_samples.h"
#include "harness/tables/terminal.h"
#include "solvers/registry.h"

namespace harness {
namespace {

void dry_run(const Suite& suite, const std::vector<Search>& searches) {
  std::size_t most = 0;
  for (const Search& search : searches) most += search.ladder.size();
  const Estimate guess = estimate(suite, searches);
  std::cout << searches.size() << " searches for a best step, at most " << most
            << " points (usually half of them), about " << duration_text(guess.seconds)
            << ", going by a few steps of " << guess.timed << " contestants and sizes\n";
}

void tell_missing_references(const SweepCommand& options, const std::vector<Search>& searches,
                             ReferenceFolder& references) {
  const auto missing = without_reference(searches, references);
  if (missing.empty()) return;
  std::string names;
  for (const auto& [scene, parameters] : missing) {
    std::string name = reference_name(scene, parameters);
    names += (names.empty() ? "" : ", ") + name.substr(0, name.rfind(".json"));
  }
  if (options.finest_error > 0)
    throw UsageError("--finest-error needs references, missing: " + names +
                     " (bench reference, with the same scene and profile, makes them)");
  std::cerr << "bench: no reference, so no trajectory error, for " << names
            << " (bench reference makes them)\n";
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

SweepRunners watched(const SweepRunners& inner, NoiseProbe& noise_probe, bool timed) {
  SweepRunners runners = inner;
  const auto budget = std::make_shared<RetakeBudget>();
  const auto own = [timed, budget](RunLimits limits) {
    limits.timed = timed;
    limits.most_retaken = budget->most();
    return limits;
  };
  runners.run = [own, budget, run = inner.run, &noise_probe](const auto& spec, const auto& limits,
                                                             auto guess) {
    noise_probe.sample_if_due();
    PointResult point = run(spec, own(limits), guess);
    budget->add(point.samples.size(), point.retaken);
    return point;
  };
  runners.repeat = [own, budget, repeat = inner.repeat, &noise_probe](auto& point,
                                                                      const auto& limits) {
    noise_probe.sample_if_due();
    const std::size_t samples = point.samples.size();
    const int retaken = point.retaken;
    repeat(point, own(limits));
    budget->add(point.samples.size() - samples, point.retaken - retaken);
  };
  return runners;
}

void warn_if_busy(const nlohmann::json& context) {
  const auto& load = context.at("load_avg");
  const double processors = context.at("num_cpus");
  if (!load.empty() && load.at(0).get<double>() > 0.5 * processors)
    std::cerr << "bench: the machine is busy (load " << number_text(load.at(0), 2) << " on "
              << processors << " processors): times will be noisy\n";
}

void tell_noise(const nlohmann::json& document) {
  const nlohmann::json& context = document.at("context");
  if (const auto pair = noise_of(context))
    std::cout << "\n"
              << pair->one << " ran twice under two names: in 95 % of " << pair->places
              << " places its two times are within " << number_text(100 * std::expm1(pair->q95), 2)
              << " % of each other; smaller differences between solvers are noise\n";
  if (document.contains("warning"))
    std::cout << "\n" << document.at("warning").get<std::string>() << '\n';
  if (!context.at("sentinel").at("noisy").get<bool>()) return;
  std::cout << "\nNOISY: a fixed kernel's time varied by "
            << number_text(100 * context.at("sentinel").at("spread").get<double>(), 2)
            << " % during the run; counters and errors are valid, compare times with care\n";
}

// The harness's own share of the shortest step that was timed.
nlohmann::json harness_overhead(const std::vector<PointResult>& points) {
  nlohmann::json overhead = {{"seconds_per_step", harness_seconds_per_step()}};
  const PointResult* shortest = nullptr;
  const auto step_seconds = [](const PointResult& p) { return p.seconds() * p.spec.step; };
  for (const PointResult& point : points) {
    if (point.ok() && !point.samples.empty() &&
        (!shortest || step_seconds(point) < step_seconds(*shortest)))
      shortest = &point;
  }
  if (!shortest) return overhead;
  overhead["shortest_step"] = step_seconds(*shortest);
  overhead["of"] = shortest->spec.id();
  return overhead;
}

void tell_overhead(const nlohmann::json& overhead) {
  if (!overhead.contains("of")) return;
  const double own = overhead.at("seconds_per_step"), step = overhead.at("shortest_step");
  std::cout << "\nthe harness's own share of the shortest timed step: " << number_text(1e9 * own, 2)
            << " ns of " << number_text(1e9 * step, 3) << " ns, "
            << number_text(100 * own / step, 2) << " % (" << overhead.at("of").get<std::string>()
            << ")\n";
}

// Runs the sweep, with progress on stderr and each run in the journal, and writes into the context
// how quiet the machine was.
SweepOutcome measured(const Suite& suite, const std::vector<Search>& searches,
                      const SweepRunners& runners, Journal& journal, bool timed,
                      nlohmann::json& context) {
  Progress progress(std::cerr, isatty(STDERR_FILENO) == 1);
  SweepEvents events;
  events.point = [&](const PointResult& p, std::size_t s, std::size_t all) {
    progress.point(p, s, all);
  };
  events.repetition = [&](std::size_t done, std::size_t all) { progress.repetition(done, all); };
  events.interrupted = interrupted;
  NoiseProbe noise_probe;
  noise_probe.sample();
  const ProcessorTicks ticks = processor_ticks();
  SweepOutcome outcome =
      run_sweep(suite, searches, events, journaled(watched(runners, noise_probe, timed), journal));
  progress.finish();
  noise_probe.sample();
  context["sentinel"] = noise_probe.to_json();
  context["stolen"] = stolen_share(ticks, processor_ticks());
  context["harness_overhead"] = harness_overhead(outcome.points);
  return outcome;
}

void print_document(const nlohmann::json& document, const std::string& out) {
  print_sweep(std::cout, document, false, output_columns());
  tell_overhead(document.at("context").at("harness_overhead"));
  tell_noise(document);
  std::cout << "\nall contestants: bench show " << out << " --all\nwritten:\n" << out << std::endl;
}

}  // namespace

int run_suite(const SweepCommand& options, const std::vector<std::string>& command) {
  const Suite suite = load_suite(options);
  auto searches = plan(suite, make_filters(options));
  if (!options.shard.empty()) searches = shard(std::move(searches), parse_shard(options.shard));
  if (options.dry_run) {
    dry_run(suite, searches);
    return success;
  }
  const std::string out = chosen_output(options, suite.name + "-" + options.sweep);
  check_writable(out);
  nlohmann::json context = machine_context();
  context["selection"] = selection(options);
  const nlohmann::json mine = identity(context, to_json(suite), context["selection"]);
  Journal journal(out);
  const Past past = begin_journal(options, out, journal,
                                  {mine, context, "points", "points", points_in, add_runs_of});
  if (past.finished) {
    std::cout << out << " is complete already\n";
    return success;
  }
  if (options.rerun_failed) forget_failures(journal);
  SweepRunners runners;
  const auto references = std::make_shared<ReferenceFolder>(source_path("results/references"));
  runners.references = references;
  tell_missing_references(options, searches, *references);
  catch_interrupts();
  std::optional<TimingLock> lock;
  if (!options.untimed) lock.emplace(!options.no_wait);
  if (lock && lock->waited()) {
    context = machine_context();
    context["selection"] = selection(options);
  }
  context["timed"] = !options.untimed;
  if (!options.untimed) warn_if_busy(context);
  if (past.context.is_object())
    context["resumed"] = {{"from", past.context.at("date")}, {"points", points_in(journal)}};

  if (!options.in_process) runners = isolated(runners, options.memory);
  const SweepOutcome outcome =
      measured(suite, searches, runners, journal, !options.untimed, context);
  const nlohmann::json document = result_document(context, suite, command, outcome.complete,
                                                  outcome.points, references->summaries());
  write_atomically(out, result_text(document));
  print_document(document, out);
  if (!outcome.complete) return tell_interrupted();
  journal.remove();
  if (!options.no_plots && !options.untimed && draw_result(out) != 0)
    std::cerr << "bench: the figures could not be drawn\n";
  return success;
}

}  // namespace harness
