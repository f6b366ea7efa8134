// bench tune: searches the settings of each solver, and writes what it found for suites to use.
#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <limits>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/json_text.h"
#include "harness/base/paths.h"
#include "harness/base/text.h"
#include "harness/base/timing_lock.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/shared_options.h"
#include "harness/cli/verbs.h"
#include "harness/points/context.h"
#include "harness/points/point_json.h"
#include "harness/run/isolation.h"
#include "harness/run/tune.h"

namespace harness {
namespace {

using nlohmann::json;

struct TuneCommand {
  std::string solver, scene, n, limits, out;
  int trials = 0;  // 0: the rule's
  double timeout = TuneOptions{}.timeout;
  bool no_wait = false, quiet = false, again = false;
};

std::vector<SweepSpec> chosen_scenes(const std::string& name) {
  std::vector<SweepSpec> scenes = tuning_scenes();
  if (name.empty()) return scenes;
  std::vector<std::string> names;
  names.reserve(scenes.size());
  for (const SweepSpec& scene : scenes) names.push_back(scene.scene);
  std::erase_if(scenes, [&name](const SweepSpec& s) { return s.scene != name; });
  if (scenes.empty()) throw unknown_name("scene to tune on", name, names);
  return scenes;
}

// All that have something to be tuned; a solver that is no contestant only by name.
std::vector<std::string> chosen_solvers(const std::string& text, const SweepSpec& scene) {
  std::vector<std::string> solvers;
  const Contestants all = competitors(*find_scene(scene.scene), scene.scene_parameters);
  const Pattern expression("--solver", text.empty() ? ".*" : text);
  for (const auto& backend : inextensible::backends()) {
    const bool competes = std::any_of(
        all.begin(), all.end(), [&](const Contestant& c) { return c.solver == backend.name; });
    if ((competes || backend.name == text) && matches(expression, backend.name) &&
        !tunable_numbers(backend).empty())
      solvers.emplace_back(backend.name);
  }
  return solvers;
}

// Whether settings by today's rule are there already.
bool stands(const std::vector<TunedEntry>& entries, const std::string& kind,
            const std::string& solver) {
  return std::any_of(entries.begin(), entries.end(), [&](const TunedEntry& e) {
    return e.kind == kind && e.solver == solver && up_to_date(e);
  });
}

// Adds what was found at places of the user's own, or takes it instead of what was found there
// before.
void add_places(TunedEntry& entry, const std::vector<TunedPlace>& found) {
  for (const TunedPlace& place : found) {
    std::erase_if(entry.places, [&](const TunedPlace& p) {
      return p.resolution == place.resolution && p.limit == place.limit;
    });
    entry.places.push_back(place);
  }
}

// In the order of scenes and solvers, whatever was tuned first.
void put_in(std::vector<TunedEntry>& entries, TunedEntry entry) {
  std::erase_if(entries, [&entry](const TunedEntry& e) {
    return e.kind == entry.kind && e.solver == entry.solver;
  });
  entries.push_back(std::move(entry));
  const auto rank = [](const TunedEntry& e) {
    const std::vector<std::string> kinds = scene_kinds();
    return std::pair(std::find(kinds.begin(), kinds.end(), e.kind) - kinds.begin(),
                     inextensible::find_backend(e.solver) - inextensible::backends().data());
  };
  std::stable_sort(entries.begin(), entries.end(),
                   [&rank](const auto& a, const auto& b) { return rank(a) < rank(b); });
}

json context_of(const TuneCommand& options) {
  const json machine = machine_context();
  return {{"date", machine.at("date")},
          {"cpu_model", machine.at("cpu_model")},
          {"commit", machine.at("build").at("git")},
          {"dirty", machine.at("build").at("dirty")},
          {"timeout", options.timeout}};
}

// The settings of a place that are an end of their range: beyond it there may be better ones.
std::string at_ends(const std::string& solver, const TunedPlace& place) {
  std::string names;
  for (const TunedNumber& n : tunable_numbers(*inextensible::find_backend(solver))) {
    const auto found = place.settings.find(n.name);
    if (found == place.settings.end()) continue;
    const double at = position_of(n, std::get<double>(found->second));
    if (at <= 0 || at >= 1) names += (names.empty() ? "  ends of ranges: " : ", ") + n.name;
  }
  return names;
}

void print(const TunedEntry& entry) {
  for (const TunedPlace& p : entry.places) {
    std::cout << std::left << std::setw(14) << entry.kind << std::setw(35) << entry.solver
              << std::setw(6) << p.resolution << std::setw(8) << number_text(100 * p.limit) + " %"
              << std::setw(7) << number_text(p.gain(), 3) << to_json(p.settings).dump()
              << at_ends(entry.solver, p) << std::endl;
  }
}

int run_tune(const TuneCommand& options) {
  auto scenes = chosen_scenes(options.scene);
  const bool own_places = !options.n.empty() || !options.limits.empty();
  if (own_places && scenes.size() != 1)
    throw UsageError("--n and --limit go with --scene: of which scene is the place?");
  if (own_places) scenes.front().scene_parameters.clear();  // the scene that results report
  if (!options.n.empty()) {
    scenes.front().resolutions.clear();
    for (const double n : numbers_of("--n", options.n, Bounds::whole_number(2)))
      scenes.front().resolutions.push_back(static_cast<int>(n));
  }
  if (!options.limits.empty())
    scenes.front().limits = numbers_of("--limit", options.limits, Bounds::strain());
  if (!options.solver.empty()) check_solver_pattern(options.solver);
  if (std::all_of(scenes.begin(), scenes.end(), [&options](const SweepSpec& scene) {
        return chosen_solvers(options.solver, scene).empty();
      }))
    throw UsageError("--solver " + options.solver + ": no setting of it is to be tuned");
  const std::string out = options.out.empty() ? source_path("configs/tuned.json") : options.out;
  std::vector<TunedEntry> entries;
  if (std::filesystem::exists(out))
    entries = parse_tuned(read_file(out, "file of tuned settings"), out).entries;
  check_writable(out);
  catch_interrupts();
  const TimingLock lock(!options.no_wait);
  TuneOptions tuning;
  if (options.trials > 0) tuning.rules.budget = tuning.trials_each = options.trials;
  tuning.timeout = options.timeout;
  tuning.interrupted = interrupted;
  if (own_places) tuning.longest_run = std::numeric_limits<double>::infinity();
  if (!options.quiet) tuning.tell = [](const std::string& line) { std::cerr << line << '\n'; };
  SweepRunners runners;
  runners.references = std::make_shared<ReferenceFolder>(source_path("results/references"));
  runners = isolated(runners, 0);
  std::cout << "kind          solver                             size  limit   gain   settings\n";
  for (const SweepSpec& scene : scenes) {
    for (const std::string& solver : chosen_solvers(options.solver, scene)) {
      if (own_places) {
        const auto known = std::find_if(entries.begin(), entries.end(), [&](const TunedEntry& e) {
          return e.kind == scene.scene && e.solver == solver;
        });
        if (known == entries.end() || !up_to_date(*known))
          throw UsageError(solver + " has no settings by today's rule yet: bench tune --scene " +
                           scene.scene + " --solver " + solver);
        TunedEntry found = tune_solver(solver, scene, tuning, runners, &*known);
        print(found);
        add_places(*known, found.places);
        write_atomically(out, document_text(tuned_document(entries)));
        continue;
      }
      if (!options.again && stands(entries, find_scene(scene.scene)->kind(), solver)) continue;
      TunedEntry entry = tune_solver(solver, scene, tuning, runners);
      entry.context = context_of(options);
      print(entry);
      put_in(entries, std::move(entry));
      write_atomically(out, document_text(tuned_document(entries)));
    }
  }
  std::cout << "\nwritten:\n" << out << std::endl;
  return success;
}

}  // namespace

Verb tune_verb() {
  return {
      "tune", "search the settings of each solver, by one rule, on scenes that no result reports",
      [](const Command& command) -> Action {
        const auto given = std::make_shared<TuneCommand>();
        TuneCommand& options = *given;
        add_solver(command, options.solver);
        command.option("--scene", options.scene,
                       "chain, drape, patch or spinning_net; default: all", "SCENE");
        command.option("--n", options.n, "sizes of your own, whose settings are added", "N,...");
        command.option("--limit", options.limits,
                       "strain limits of your own, whose settings are added", "STRAIN,...");
        command
            .option("--trials", options.trials,
                    "sets of settings to try for each solver, size and limit; default: 10 for each "
                    "setting, at most 40",
                    "N")
            .within(4, 10000);
        add_timeout(command, options.timeout, "10");
        command.flag("--again", options.again, "also what is up to date");
        command.option("--out", options.out, "the settings; default: configs/tuned.json", "FILE");
        command.flag("--quiet", options.quiet, "no line for each set of settings");
        add_no_wait(command, options.no_wait);
        return [given] { return run_tune(*given); };
      }};
}

}  // namespace harness
