// bench --sweep: runs a suite's sweeps, or the matrix of hard cases.
#include <unistd.h>

#include <iostream>
#include <sstream>

#include "commands.h"
#include "context.h"
#include "files.h"
#include "report.h"
#include "result_file.h"
#include "stability.h"
#include "sweep_options.h"
#include "text.h"
#include "usage_error.h"

namespace harness {
namespace {

struct SweepCommand : SweepOptions {
  std::string hard_case, out;
  std::vector<std::string> values;
  bool dry_run = false, no_plots = false;
};

// Upper bounds, told before anything runs.
void dry_run(const Suite& suite, const std::vector<Search>& searches) {
  std::size_t most = 0;
  double seconds = 0;
  for (const Search& search : searches) {
    most += search.ladder.size();
    // Coarse figures of one common machine: seconds that a search takes, by constraints.
    const double size = search.base.constraints;
    const bool chain = search.base.scene == "chain";
    const double unit =
        search.base.solver == "implicit_springs" || search.base.solver == "icd" ? 6e-3 : 2e-3;
    seconds += std::min(4 * suite.timeout, (chain ? 0.1 : 1.0) * unit * size);
  }
  std::cout << searches.size() << " searches for a best step, at most " << most
            << " points (usually half of them), about " << duration_text(seconds)
            << " (a rough guess), at most "
            << duration_text(2 * suite.timeout * static_cast<double>(most)) << '\n';
}

void tell_missing_references(const Suite& suite, const std::vector<Search>& searches,
                             ReferenceShelf& shelf) {
  const auto missing = without_reference(searches, shelf);
  if (missing.empty()) return;
  std::string names;
  for (const auto& [scene, parameters] : missing) {
    std::string name = reference_name(scene, parameters);
    names += (names.empty() ? "" : ", ") + name.substr(0, name.rfind(".json"));
  }
  if (suite.max_error > 0)
    throw UsageError("--max-error needs references, missing: " + names +
                     " (bench reference, with the same scene and profile, makes them)");
  std::cerr << "bench: no reference, so no trajectory error, for " << names
            << " (bench reference makes them)\n";
}

int sweep(const SweepCommand& options, const std::vector<std::string>& command) {
  const Suite suite = load_suite(options);
  const auto searches = plan(suite, make_filters(options));
  if (options.dry_run) {
    dry_run(suite, searches);
    return success;
  }
  const std::string out =
      options.out.empty()
          ? source_path("results/local/" + suite.name + "-" + options.sweep + ".json")
          : options.out;
  check_writable(out);
  const nlohmann::json context = machine_context();

  catch_interrupts();
  Progress progress(std::cerr, isatty(STDERR_FILENO) == 1);
  SweepEvents events;
  events.point = [&](const PointResult& p, std::size_t s, std::size_t all) {
    progress.point(p, s, all);
  };
  events.repetition = [&](std::size_t done, std::size_t all) { progress.repetition(done, all); };
  events.interrupted = interrupted;
  SweepRunners runners;
  runners.references = std::make_shared<ReferenceShelf>(source_path("results/references"));
  tell_missing_references(suite, searches, *runners.references);
  const SweepOutcome outcome = run_sweep(suite, searches, events, runners);
  progress.finish();

  write_atomically(out, result_document(context, suite, command, outcome.complete, outcome.points,
                                        runners.references->summaries())
                                .dump(1) +
                            "\n");
  print_table(std::cout, outcome.points);
  std::cout << "\nwritten:\n" << out << std::endl;
  if (!outcome.complete) return interrupted_exit;
  if (!options.no_plots && draw({out}) != 0) std::cerr << "bench: the figures could not be drawn\n";
  return success;
}

// "ratios=1e3,1e5" into `values`.
void set_values(HardCaseValues& values, const std::string& given) {
  const auto equals = given.find('=');
  const std::string name = given.substr(0, equals);
  const auto place = values.find(name);
  if (place == values.end()) {
    std::vector<std::string> names;
    for (const auto& entry : values) names.push_back(entry.first);
    throw unknown_name("value of hard cases", name, names);
  }
  place->second.clear();
  std::istringstream list(equals == std::string::npos ? "" : given.substr(equals + 1));
  for (std::string item; std::getline(list, item, ',');) {
    std::size_t read = 0;
    try {
      place->second.push_back(std::stod(item, &read));
    } catch (const std::exception&) {
      read = 0;
    }
    if (read == 0 || read != item.size())
      throw UsageError("--values " + given + ": '" + item + "' is not a number");
  }
  if (place->second.empty())
    throw UsageError("--values " + given + ": must be NAME=NUMBER,NUMBER,...");
}

// The matrix of hard cases; its cases are in the program, not in a suite.
int stability(const SweepCommand& options, const std::vector<std::string>& command) {
  check_profile(options.profile);
  StabilityFilters filters;
  if (!options.solver.empty()) {
    check_solver_pattern(options.solver);
    filters.solver = pattern("--solver", options.solver);
  }
  if (!options.hard_case.empty()) filters.hard_case = pattern("--case", options.hard_case);
  HardCaseValues values = hard_case_values(options.profile);
  for (const std::string& given : options.values) set_values(values, given);
  const auto cases = hard_cases(values);
  const std::string out = options.out.empty()
                              ? source_path("results/local/" + options.profile + "-stability.json")
                              : options.out;
  check_writable(out);
  const nlohmann::json context = machine_context();
  catch_interrupts();
  StabilityEvents events;
  events.interrupted = interrupted;
  const bool terminal = isatty(STDERR_FILENO) == 1;
  events.cell = [terminal](const StabilityCell& cell, std::size_t done, std::size_t all) {
    if (terminal) {
      std::cerr << "\r\033[K[" << done << '/' << all << "] " << cell.hard_case->name << '/'
                << cell.solver << (done == all ? "\n" : "");
    } else if (done % 100 == 0 || done == all) {
      std::cerr << '[' << done << '/' << all << "]\n";
    }
  };
  events.largest_step = [](const LargestStep& found) {
    std::cerr << "largest step, " << found.scene << '/' << found.solver << '\n';
  };
  const std::uint64_t seed = options.seed < 0 ? 1 : static_cast<std::uint64_t>(options.seed);
  const StabilityOutcome outcome = run_stability(cases, filters, seed, events);
  write_atomically(out, stability_document(context, outcome, seed, command).dump(1) + "\n");
  print_stability(std::cout, outcome);
  std::cout << "\nwritten:\n" << out << std::endl;
  if (!outcome.complete) return interrupted_exit;
  if (!options.no_plots && draw({out}) != 0) std::cerr << "bench: the figure could not be drawn\n";
  return outcome.as_expected() ? success : unexpected_outcome;
}

}  // namespace

void add_sweep_command(CLI::App& app, Chosen& chosen, const std::vector<std::string>& command) {
  const auto given = std::make_shared<SweepCommand>();
  SweepCommand& options = *given;
  add_selection(app, options);
  app.add_option("--out", options.out, "result file; default results/local/<profile>-<axis>.json")
      ->type_name("FILE");
  app.add_option("--reps", options.reps, "runs of each best point")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  app.add_option("--timeout", options.timeout, "seconds a point may take")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  app.add_option("--step", options.step,
                 "search (each solver's best step, default), all (the whole ladder) or adaptive "
                 "(one run from the coarsest step, halved where the solver refuses it)")
      ->type_name("HOW");
  app.add_option("--finest", options.finest, "smallest step of the ladder instead of the suite's")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  app.add_option("--max-error", options.max_error,
                 "also find the fastest step within this trajectory error, over the scene's size")
      ->check(CLI::PositiveNumber)
      ->type_name("E");
  app.add_option("--seed", options.seed, "of random orders")
      ->check(CLI::NonNegativeNumber)
      ->type_name("N");
  app.add_option("--case", options.hard_case,
                 "stability: only cases in whose name this is found, e.g. 'Q[12]'")
      ->type_name("REGEX");
  app.add_option("--values", options.values,
                 "stability: what a family of cases runs over, e.g. ratios=1e3,1e5 (distances, "
                 "limits, ratios, links, sides, scales)")
      ->type_name("NAME=LIST");
  app.add_flag("--dry-run", options.dry_run, "say what would run and how long, and stop");
  app.add_flag("--no-plots", options.no_plots, "no figures at the end");

  app.callback([given, &app, &chosen, &command] {
    if (!app.get_subcommands().empty()) return;
    chosen = [given, &command] {
      if (given->sweep.empty())
        throw UsageError(
            "nothing to do: give --sweep strain, resolution, step or stability (see bench --help)");
      if (given->sweep == "stability") return stability(*given, command);
      if (!given->hard_case.empty() || !given->values.empty())
        throw UsageError("--case and --values go with --sweep stability");
      return sweep(*given, command);
    };
  });
}

}  // namespace harness
