// bench --sweep strain|resolution|step|stability, and the sweeps of a suite.
#include <set>

#include "harness/base/statistics.h"
#include "harness/base/timing_lock.h"
#include "harness/cli/command.h"
#include "harness/points/context.h"
#include "harness/points/plugins.h"
#include "harness/points/result_file.h"
#include "harness/run/machine_noise.h"
#include "harness/stability/stability.h"

namespace harness {
namespace {

// Probes the machine's noise between runs.
Runner watched(const Runner& inner, NoiseProbe& noise_probe, bool timed) {
  return [=, &noise_probe](const PointSpec& spec, RunLimits limits) {
    limits.timed = timed;
    noise_probe.sample_if_due();
    return inner(spec, limits);
  };
}

void warn_if_busy(const json& context) {
  const auto& load = context.at("load_avg");
  const double processors = context.at("num_cpus");
  if (!load.empty() && load.at(0).get<double>() > 0.5 * processors)
    std::cerr << "bench: the machine is busy (load " << number_text(load.at(0), 2) << " on "
              << processors << " processors): times will be noisy\n";
}

SweepEvents shown(Progress& progress) {
  SweepEvents events;
  events.interrupted = interrupted;
  events.point = [&progress, points = 0](const PointResult& p, double s, double all) mutable {
    const std::string found = !p.ok()             ? to_string(p.status)
                              : p.samples.empty() ? "no time"
                                                  : duration_text(p.seconds()) + "/s";
    progress.show((s + 0.5) / all, counted(++points, "point"), p.spec.id() + " " + found);
  };
  events.repetition = [&progress, first = true](std::size_t done, std::size_t all) mutable {
    if (std::exchange(first, false)) progress.begin_part();
    progress.show(done, all, "re-timing the best runs");
  };
  return events;
}

void add_cells_of(const json& result, Journal& journal) {
  for (const json& row : result.at("matrix"))
    journal.add(cell_key(row.at("case"), row.at("solver")), to_json(trial_result_of(row)));
}

struct SweepCommand : SweepOptions, OutputOptions {
  double memory = 0;  // bytes; 0: no limit
  bool dry_run = false, no_wait = false;
  std::string hard_case;        // with --sweep stability
  Command of_suites, of_cases;  // options of one kind of sweep only

  void declare(const Command& command) {
    of_suites = command.group("with --sweep strain, resolution and step");
    of_cases = command.group("with --sweep stability");
    SweepOptions::declare(command, of_suites);
    OutputOptions::declare(command, "<profile>-<axis>.json");
    command.flag("--dry-run", dry_run, "print what would run and how long, and stop");
    add_no_wait(command, no_wait);
    of_suites.byte_count("--memory", memory, "address space a point may have, e.g. 4G");
    of_cases.option("--case", hard_case, "only cases whose name contains a match, e.g. 'Q[12]'",
                    "REGEX");
  }

  // ---- Sweeps of a suite ----

  static int print_plan(const Suite& suite, const std::vector<Search>& searches) {
    std::size_t most = 0;
    for (const Search& search : searches) most += search.ladder.size();
    for (const SweepSpec& sweep : suite.sweeps) std::cout << find_scene(sweep.scene)->description;
    const Estimate guess = estimate(suite, searches);
    std::cout << counted(searches.size(), "search", "searches") << " for a best step, at most "
              << counted(most, "point") << " (usually half of them), about "
              << duration_text(guess.seconds) << ", estimated from a few steps of "
              << counted(guess.timed, "contestant and size", "contestants and sizes") << '\n';
    return success;
  }

  // Scenes that a plug-in's solver, or one that is asked for, cannot run.
  void report_left_out(const Suite& suite) const {
    std::set<std::string> wanted;
    for (const Plugin& plugin : loaded_plugins())
      wanted.insert(plugin.solvers.begin(), plugin.solvers.end());
    std::string all;
    for (const SweepSpec& spec : suite.sweeps)
      for (const auto& backend : backends()) {
        const auto asked = filters_of(*this).solver;
        if (asked ? !matches(*asked, backend.name) : !wanted.contains(backend.name)) continue;
        if (std::ranges::count(spec.contestants, backend.name, &Contestant::solver) > 0) continue;
        const auto type = find_scene(spec.scene);
        const std::string part = not_taken(backend, *type, spec.scene_parameters);
        const std::string one = concat(spec.scene, " by ", backend.name, " (", part, ")");
        if (!part.empty() && all.find(one) == std::string::npos) append(all, one);
      }
    if (!all.empty())
      std::cerr << "bench: left out, because a solver does not take a part of the scene: " << all
                << '\n';
  }

  void report_missing_references(const std::vector<Search>& searches,
                                 ReferenceFolder& references) const {
    const auto missing = without_reference(searches, references);
    if (missing.empty()) return;
    std::string names;
    for (const auto& [file, scene_of_file] : missing)
      append(names, file.substr(0, file.rfind(".json")));
    if (finest_error > 0)
      throw UsageError("--finest-error needs references, missing: " + names +
                       " (bench reference, with the same scene and profile, makes them)");
    std::cerr << "bench: no reference, so no trajectory error, for " << names
              << " (bench reference makes them)\n";
  }

  // Includes the options that choose points of the suite.
  json context_of_suite() const {
    json context = machine_context();
    context["selection"] = {{"solver", solver}, {"filter", filter}, {"exclude", exclude}};
    // An untimed run must not be resumed as a timed one.
    if (untimed) context["selection"]["untimed"] = true;
    return context;
  }

  int run_suite(const Words& typed) const {
    const Suite suite = load_suite(*this);
    const auto searches = plan(suite, filters_of(*this));
    report_left_out(suite);
    if (dry_run) return print_plan(suite, searches);
    json context = context_of_suite();
    const auto run = [&](Journal& journal, const json& before) -> Finished {
      const auto references = ReferenceFolder::usual();
      for (const SweepSpec& spec : suite.sweeps) std::cerr << find_scene(spec.scene)->remarks;
      report_missing_references(searches, *references);
      std::optional<TimingLock> lock;
      if (!untimed) lock.emplace(!no_wait);
      if (lock && lock->waited()) context = context_of_suite();
      context["timed"] = !untimed;
      if (!untimed) warn_if_busy(context);
      if (before.is_object())
        context["resumed"] = {{"from", before.at("date")}, {"points", points_in(journal)}};
      Progress progress;
      NoiseProbe noise_probe;
      noise_probe.sample();
      const Runner watching = watched(isolated(run_point, memory), noise_probe, !untimed);
      const SweepOutcome outcome =
          run_sweep(suite, searches, shown(progress),
                    with_references(journaled(watching, journal), references));
      noise_probe.sample();
      context["sentinel"] = noise_probe.to_json();
      return {result_document(context, suite, typed, outcome.complete, outcome.points,
                              references->summaries()),
              outcome.complete};
    };
    OutputOptions output = *this;
    output.no_plots |= untimed;
    return carry_out(output, {suite.name + "-" + sweep, context, to_json(suite), "points", "points",
                              run, add_runs_of, points_in});
  }

  // ---- Hard cases: they are in the program, not in a suite ----

  int run_hard_cases(const Words& typed) const {
    check_known("profile", profile, profiles());
    const StabilityPlan plan =
        plan_stability(profile, solver_pattern(solver), pattern_of("--case", hard_case));
    if (dry_run) {
      std::cout << plan.cells() << " cells: " << plan.cases.size() << " hard cases by "
                << plan.solvers.size() << " solvers; " << plan.scenes.size()
                << " scenes for each solver's largest step, " << plan.frames.size()
                << " for frames side by side\n";
      return success;
    }
    json context = machine_context();
    context["selection"] = {{"solver", solver},
                            {"case", hard_case},
                            {"values", hard_case_values(profile)},
                            {"seed", seed}};
    const auto run = [&](Journal& journal, const json&) -> Finished {
      Progress progress;
      const std::uint64_t first = seed < 0 ? 1 : static_cast<std::uint64_t>(seed);
      const auto outcome = run_stability(plan, first, journaled_events(journal, progress));
      return {stability_document(context, outcome, first, typed), outcome.complete,
              outcome.counts().new_differences == 0 ? success : unexpected_outcome};
    };
    return carry_out(*this,
                     {profile + "-stability", context, {}, "matrix", "cells", run, add_cells_of});
  }

  int run(const Words& typed) const {
    if (sweep.empty())
      throw UsageError(
          "nothing to do: give --sweep strain, resolution, step or stability (see bench --help)");
    const bool hard_cases = sweep == "stability";
    const Command& others = hard_cases ? of_suites : of_cases;
    if (const std::string name = others.one_typed(); !name.empty())
      throw UsageError(name + " goes " + others.heading() + " only" +
                       (hard_cases ? " (--case chooses hard cases)" : ""));
    return hard_cases ? run_hard_cases(typed) : run_suite(typed);
  }
};

// ---- A result's best points timed again, on another day or machine ----

struct RepeatCommand {
  std::string file;
  bool no_wait = false;

  void declare(const Command& command) {
    command.option("file", file, "a complete result of a sweep", "FILE");
    command.require({"file"});
    add_no_wait(command, no_wait);
  }

  // What is timed again, and the rows of the document that it is from.
  struct Best {
    std::vector<std::size_t> rows;
    std::vector<PointResult> points;
  };

  static Best best_of(const json& document, const std::string& file) {
    Best best;
    for (std::size_t i = 0; i < document.at("points").size(); ++i) {
      const PointResult point = point_of(document.at("points")[i]);
      if (!point.best_somewhere()) continue;
      if (!find_backend(point.spec.solver))
        throw UsageError("'" + file + "' has runs of '" + point.spec.solver +
                         "', which this program does not know: load it with --plugin");
      best.rows.push_back(i);
      best.points.push_back(point);
    }
    if (best.rows.empty()) throw UsageError("'" + file + "' has no best points to be timed again");
    return best;
  }

  // A repetition that was interrupted is continued by the same program.
  static void begin(Journal& journal, const json& document, const json& context) {
    const json header = {{"schema", "inextensible-journal/2"},
                         {"occasion", document.at("context").value("occasions", json::array())},
                         {"program", context.at("build").at("binary")},
                         {"processor", context.at("cpu_model")}};
    if (journal.header() == header)
      journal.go_on(header);
    else
      journal.start(header);
  }

  // Adds the occasion to the document.
  static void add(json& document, const json& context, const std::optional<PairNoise>& noise,
                  const Best& timed) {
    json& occasions = document["context"]["occasions"];
    occasions.push_back({{"date", context.at("date")},
                         {"cpu_model", context.at("cpu_model")},
                         {"commit", context.at("build").at("git")},
                         {"load_avg", context.at("load_avg")},
                         {"noise", noise ? json(noise->q95) : json()}});
    std::vector<std::vector<double>> all;
    for (std::size_t i = 0; i < timed.rows.size(); ++i) {
      json& row = document["points"][timed.rows[i]];
      PointResult point = point_of(row);
      const PointResult& more = timed.points[i];
      if (!more.samples.empty())
        point.occasions.push_back(
            {static_cast<double>(occasions.size()), more.seconds(), quantile(more.samples, 0.5)});
      row = row_of(point);
      auto& times = all.emplace_back();
      for (const auto& [unused, seconds] : point.times()) times.push_back(seconds);
    }
    document["context"]["scatter"] = number(scatter_of(all));
  }

  // The document with these times in place of its own, which are not to be quoted.
  static json instead(const json& document, const json& context, const Suite& suite,
                      const Best& timed) {
    std::vector<PointResult> points;
    for (const json& row : document.at("points")) points.push_back(point_of(row));
    for (std::size_t i = 0; i < timed.rows.size(); ++i)
      if (!timed.points[i].samples.empty()) points[timed.rows[i]] = timed.points[i];
    const json& was = document.at("context");
    json now = result_document(was, suite, {}, true, points, document.at("references"));
    now["legend"] = document.at("legend");
    for (const char* key : {"command", "suite", "seed"}) now["context"][key] = was.at(key);
    for (const char* key : {"date", "cpu_model", "load_avg"}) now["context"][key] = context.at(key);
    return now;
  }

  int run() const {
    json document = read_result(file);
    if (!is_sweep(document) || !is_timed(document) || !document.value("complete", true))
      throw UsageError("'" + file + "' is not a complete, timed result of a sweep over strain, " +
                       "resolution or step");
    Best best = best_of(document, file);
    Suite suite = document.at("context").at("suite");
    suite.same = document.at("context").at("suite").value("same", "");
    const TimingLock lock(!no_wait);
    const json context = machine_context();
    warn_if_busy(context);
    Journal journal(file);
    begin(journal, document, context);
    Progress progress;
    NoiseProbe noise_probe;
    std::vector<Samples> samples;
    try {
      samples = time_again(suite, best.points, shown(progress),
                           journaled(watched(isolated(run_point, 0), noise_probe, true), journal));
    } catch (const Interrupted&) {
      std::cerr << "bench: interrupted; the same command continues from here\n";
      return interrupted_exit;
    }
    progress.clear();
    std::size_t lost = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      static_cast<Samples&>(best.points[i]) = samples[i];
      lost += samples[i].samples.empty();
    }
    const auto noise = pair_noise(best.points, suite.same);
    if (const std::string why = noise ? why_not_quotable(*noise) : ""; !why.empty()) {
      journal.remove();
      std::cerr << "bench: not added, '" << file << "' stays as it was: " << why << '\n';
      return cannot_decide;
    }
    if (document.contains("warning"))
      document = instead(document, context, suite, best);
    else
      add(document, context, noise, best);
    write_atomically(file, result_text(document));
    journal.remove();
    std::cout << file << ": occasion " << document["context"].value("occasions", json()).size() + 1
              << "; best points timed: " << best.rows.size() - lost;
    if (lost > 0) std::cout << "; runs that did not end well this time: " << lost;
    const json scatter = document["context"].value("scatter", json());
    if (scatter.is_number())
      std::cout << "; a ratio of two times varies by "
                << number_text(100 * scatter.get<double>(), 2)
                << " % (standard deviation) between occasions";
    std::cout << '\n';
    return success;
  }
};

}  // namespace

Action repeat_verb(const Command& command) { return verb<RepeatCommand>(command); }
Action sweep_verb(const Command& command) { return verb<SweepCommand>(command); }

}  // namespace harness
