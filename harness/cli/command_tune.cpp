// bench tune: searches the settings of each solver and writes them to a file that suites use.
#include <iomanip>

#include "harness/base/table.h"
#include "harness/base/timing_lock.h"
#include "harness/cli/command.h"
#include "harness/points/context.h"
#include "harness/run/tune.h"

namespace harness {
namespace {

// Solvers with tunable settings; one that is not a contestant must be named in full.
std::vector<std::string> chosen_solvers(const std::string& text, const SweepSpec& scene) {
  std::vector<std::string> solvers;
  const Contestants all = competitors(*find_scene(scene.scene), scene.scene_parameters);
  const Pattern expression("--solver", text.empty() ? ".*" : text);
  for (const auto& backend : backends()) {
    const bool competes = std::ranges::count(all, backend.name, &Contestant::solver) > 0;
    if ((competes || backend.name == text) && matches(expression, backend.name) &&
        !tunable_numbers(backend).empty())
      solvers.emplace_back(backend.name);
  }
  return solvers;
}

using Entries = std::vector<TunedEntry>;

void print(const TunedEntry& entry) {
  for (const TunedPlace& p : entry.places)
    std::cout << std::left << std::setw(15) << entry.kind << std::setw(35) << entry.solver
              << std::setw(6) << p.resolution << std::setw(8) << number_text(100 * p.limit) + " %"
              << std::setw(7) << number_text(p.gain(), 3) << json(p.settings).dump() << std::endl;
}

struct Tune {
  std::string solver, scene, out;
  Numbers n, limits;
  int trials = 0;  // 0: the rule's
  TuneOptions options;
  bool no_wait = false, again = false;

  void declare(const Command& command) {
    add_solver(command, solver);
    command.option("--scene", scene,
                   "chain, drape, settling_drape, patch or spinning_net; default: all", "SCENE");
    command.option("--n", n, "sizes of your own, whose settings are added", "N",
                   Bounds::whole_number(2));
    command.option("--limit", limits, "strain limits of your own, whose settings are added",
                   "STRAIN", Bounds::strain());
    command.option("--trials", trials,
                   "sets of settings to try for each solver, size and limit; default: 10 for each "
                   "setting, at most 40",
                   "N", {.least = 4, .most = 10000, .whole = true});
    add_timeout(command, options.timeout, "10");
    command.flag("--again", again, "also tune what is up to date");
    command.option("--out", out, "the settings; default: configs/tuned.json", "FILE");
    add_no_wait(command, no_wait);
  }

  bool own_places() const { return !n.empty() || !limits.empty(); }

  std::vector<SweepSpec> scenes() const {
    std::vector<SweepSpec> chosen = tuning_scenes();
    if (!scene.empty()) {
      check_known("scene to tune on", scene,
                  in_order(chosen, [](const SweepSpec& s) { return s.scene; }));
      std::erase_if(chosen, [this](const SweepSpec& s) { return s.scene != scene; });
    }
    if (!own_places()) return chosen;
    if (chosen.size() != 1) throw UsageError("--n and --limit go with --scene");
    SweepSpec& one = chosen.front();
    one.scene_parameters.clear();  // use the scene that results report
    if (!n.empty()) one.resolutions.assign(n.begin(), n.end());
    if (!limits.empty()) one.limits = limits;
    return chosen;
  }

  // Stores the result in `entries`. False: its entry is up to date.
  bool tune_one(const SweepSpec& on, const std::string& name, const Runner& run,
                Entries& entries) const {
    const auto known = std::ranges::find_if(entries, [&](const TunedEntry& entry) {
      return entry.kind == find_scene(on.scene)->kind() && entry.solver == name;
    });
    const bool there = known != entries.end() && rule_change(*known).empty();
    if (own_places()) {
      if (!there)
        throw UsageError(
            name + " has no settings by today's rule yet: " + tune_command(on.scene, name, out));
      // What is best elsewhere, and in other steppers, is tried first.
      std::vector<Settings> others;
      for (const TunedEntry& entry : entries)
        if (entry.kind == known->kind && method_of(entry.solver) == method_of(name))
          for (const TunedPlace& place : entry.places) others.push_back(place.settings);
      const TunedEntry found = tune_solver(name, on, options, run, &*known, others);
      print(found);
      for (const TunedPlace& place : found.places) {
        std::erase_if(known->places, [&](const TunedPlace& p) {
          return p.resolution == place.resolution && p.limit == place.limit;
        });
        known->places.push_back(place);
      }
      return true;
    }
    if (there && !again) return false;
    TunedEntry entry = tune_solver(name, on, options, run);
    const json machine = machine_context();
    const json& build = machine.at("build");
    entry.context = {{"date", machine.at("date")},
                     {"cpu_model", machine.at("cpu_model")},
                     {"commit", build.at("git")},
                     {"dirty", build.at("dirty")},
                     {"timeout", options.timeout}};
    print(entry);
    if (known != entries.end()) entries.erase(known);
    entries.push_back(std::move(entry));
    return true;
  }

  int run() {
    const std::vector<SweepSpec> chosen = scenes();
    if (trials > 0) options.budget = options.trials_each = trials;
    options.interrupted = interrupted;
    if (own_places()) options.longest_run = std::numeric_limits<double>::infinity();
    options.tell = [](const std::string& line) { std::cerr << line << '\n'; };
    (void)solver_pattern(solver);
    if (std::ranges::all_of(
            chosen, [this](const SweepSpec& s) { return chosen_solvers(solver, s).empty(); }))
      throw UsageError("--solver " + solver + ": it has no tunable settings");
    const std::string file = out.empty() ? source_path("configs/tuned.json") : out;
    Entries entries;
    if (std::filesystem::exists(file))
      entries = parse_tuned(read_file(file, "file of tuned settings"), file).entries;
    check_writable(file);
    const TimingLock lock(!no_wait);
    const Runner run = with_references(isolated(run_point, 0), ReferenceFolder::usual());
    std::cout
        << "kind           solver                             size  limit   gain   settings\n";
    for (const SweepSpec& on : chosen)
      for (const std::string& name : chosen_solvers(solver, on)) {
        if (!tune_one(on, name, run, entries)) continue;
        std::ranges::stable_sort(entries, {}, [kinds = scene_kinds()](const TunedEntry& entry) {
          return std::pair(std::ranges::find(kinds, entry.kind) - kinds.begin(),
                           find_backend(entry.solver));
        });
        write_atomically(file, document_text(tuned_document(entries)));
      }
    std::cout << "\nwritten:\n" << file << std::endl;
    return success;
  }
};

}  // namespace

Action tune_verb(const Command& command) { return verb<Tune>(command); }

}  // namespace harness
