// bench: the command line.
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "build_info.h"  // made by CMake
#include "claims.h"
#include "context.h"
#include "files.h"
#include "report.h"
#include "result_file.h"
#include "stability.h"
#include "sweep.h"
#include "text.h"
#include "usage_error.h"

namespace harness {
namespace {

enum ExitCode {
  success = 0,
  internal_error = 1,
  usage_error = 2,
  unexpected_outcome = 4,
  interrupted_exit = 130
};

volatile std::sig_atomic_t interrupt_requested = 0;

struct Options {
  std::string sweep, scene, solver, hard_case, filter, exclude, config, out, profile = "default",
                                                                             step = "search";
  std::vector<std::string> values;
  int reps = 0;
  double timeout = 0, max_error = 0;
  std::int64_t seed = -1;
  bool dry_run = false, no_plots = false;
};

std::string source_path(const std::string& relative) {
  return std::string(INEXTENSIBLE_SOURCE_DIR) + "/" + relative;
}

std::vector<std::string> profiles() { return {"quick", "default", "paper"}; }

std::regex pattern(const std::string& option, const std::string& text) {
  try {
    return std::regex(text, std::regex::ECMAScript | std::regex::icase);
  } catch (const std::regex_error& error) {
    throw UsageError(option + " '" + text + "' is not a regular expression: " + error.what());
  }
}

// A solver given as a plain name must exist; anything else is a regular expression that must match
// some name.
void check_solver_pattern(const std::string& text) {
  std::vector<std::string> names;
  for (const auto& backend : inextensible::backends()) names.emplace_back(backend.name);
  const std::regex expression = pattern("--solver", text);
  for (const std::string& name : names) {
    if (std::regex_match(name, expression)) return;
  }
  throw unknown_name("solver", text, names);
}

// The suite's file; refuses unknown profiles and scenes.
std::string suite_path(const Options& options) {
  if (!options.scene.empty() && !find_scene(options.scene)) {
    std::vector<std::string> names;
    for (const auto& type : scene_types()) names.emplace_back(type.name);
    throw unknown_name("scene", options.scene, names);
  }
  if (!options.config.empty()) return options.config;
  const auto known = profiles();
  if (std::find(known.begin(), known.end(), options.profile) == known.end())
    throw unknown_name("profile", options.profile, known);
  return source_path("configs/" + options.profile + ".json");
}

Suite load_suite(const Options& options) {
  if (!options.solver.empty()) check_solver_pattern(options.solver);
  const std::string path = suite_path(options);
  Suite suite = read_suite(path);
  std::vector<std::string> kinds = sweep_kinds();
  if (std::find(kinds.begin(), kinds.end(), options.sweep) == kinds.end()) {
    kinds.emplace_back("stability");
    throw unknown_name("sweep", options.sweep, kinds);
  }
  std::erase_if(suite.sweeps, [&](const SweepSpec& s) {
    return s.sweep != options.sweep || (!options.scene.empty() && s.scene != options.scene);
  });
  if (suite.sweeps.empty())
    throw UsageError("'" + path + "' has no such sweep: --sweep " + options.sweep + " --scene " +
                     options.scene);
  if (options.step != "search" && options.step != "adaptive")
    throw unknown_name("step", options.step, {"search", "adaptive"});
  if (options.step == "adaptive") {
    if (options.sweep == "step")
      throw UsageError("--step adaptive does not go with --sweep step, whose steps are fixed");
    for (SweepSpec& sweep : suite.sweeps) sweep.adaptive = true;
    suite.name += "-adaptive";  // files and figures of their own
  }
  if (options.reps > 0) suite.reps = options.reps;
  if (options.timeout > 0) suite.timeout = options.timeout;
  if (options.max_error > 0) suite.max_error = options.max_error;
  if (options.seed >= 0) suite.seed = static_cast<std::uint64_t>(options.seed);
  // A solver that is no contestant joins when it is asked for by its own name.
  if (const auto* backend = inextensible::find_backend(options.solver);
      backend && !backend->contestant) {
    for (SweepSpec& sweep : suite.sweeps) sweep.solvers = {options.solver};
  }
  return suite;
}

SweepFilters make_filters(const Options& options) {
  SweepFilters filters;
  if (!options.solver.empty()) filters.solver = pattern("--solver", options.solver);
  if (!options.filter.empty()) filters.include = pattern("--filter", options.filter);
  if (!options.exclude.empty()) filters.exclude = pattern("--exclude", options.exclude);
  return filters;
}

// Runs the plotting script; its paths go to stdout as they are. Figures are a by-product: a failure
// is told, not fatal.
int draw(const std::vector<std::string>& arguments) {
  std::cout.flush();
  const pid_t child = fork();
  if (child == 0) {
    const std::string script = source_path("plots/figures.py");
    std::vector<char*> argv;
    std::vector<std::string> words{"/usr/bin/python3", script};
    words.insert(words.end(), arguments.begin(), arguments.end());
    argv.reserve(words.size() + 1);
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) < 0) return internal_error;
  return WIFEXITED(status) ? WEXITSTATUS(status) : internal_error;
}

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

// Scenes of the plan without a reference: their points carry no trajectory error.
std::vector<std::pair<std::string, SceneParameters>> without_reference(
    const std::vector<Search>& searches, ReferenceShelf& shelf) {
  std::map<std::string, std::pair<std::string, SceneParameters>> missing;
  for (const Search& search : searches) {
    const auto& [scene, parameters] = std::pair(search.base.scene, search.base.scene_parameters);
    if (!shelf.find(scene, parameters))
      missing[reference_name(scene, parameters)] = {scene, parameters};
  }
  std::vector<std::pair<std::string, SceneParameters>> list;
  list.reserve(missing.size());
  for (auto& [name, scene] : missing) list.push_back(std::move(scene));
  return list;
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

// Computes the references of a profile's sweeps that are missing, or all of them.
int make_references(const Options& options, bool again, double finest) {
  Suite suite = read_suite(suite_path(options));
  std::erase_if(suite.sweeps, [&](const SweepSpec& s) {
    return (!options.sweep.empty() && s.sweep != options.sweep) ||
           (!options.scene.empty() && s.scene != options.scene);
  });
  if (suite.sweeps.empty()) throw UsageError("no sweep of the suite has such a scene");
  const auto searches = plan(suite, {});
  const std::string folder = source_path("results/references");
  ReferenceShelf shelf(again ? "" : folder);
  const auto missing = without_reference(searches, shelf);
  if (missing.empty()) std::cout << "nothing is missing (--again computes them anew)\n";
  for (const auto& [scene, parameters] : missing) {
    const std::string name = reference_name(scene, parameters);
    const std::string path = folder + "/" + name;
    check_writable(path);
    const Reference reference = compute_reference(
        scene, parameters, finest,
        [&name](const std::string& line) { std::cerr << name << ": " << line << '\n'; });
    write_atomically(path, to_json(reference).dump() + "\n");
    print_reference(std::cout, reference);
    std::cout << path << std::endl;
  }
  return success;
}

int claims(const std::vector<std::string>& files, bool markdown) {
  std::vector<nlohmann::json> results;
  results.reserve(files.size());
  for (const std::string& file : files) results.push_back(read_result(file));
  (markdown ? print_claims_markdown : print_claims)(std::cout, judge_claims(results));
  return success;
}

int sweep(const Options& options, const std::vector<std::string>& command) {
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

  std::signal(SIGINT, [](int) { interrupt_requested = 1; });
  std::signal(SIGTERM, [](int) { interrupt_requested = 1; });
  Progress progress(std::cerr, isatty(STDERR_FILENO) == 1);
  SweepEvents events;
  events.point = [&](const PointResult& p, std::size_t s, std::size_t all) {
    progress.point(p, s, all);
  };
  events.repetition = [&](std::size_t done, std::size_t all) { progress.repetition(done, all); };
  events.interrupted = [] { return interrupt_requested != 0; };
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
int stability(const Options& options, const std::vector<std::string>& command) {
  const auto known = profiles();
  if (std::find(known.begin(), known.end(), options.profile) == known.end())
    throw unknown_name("profile", options.profile, known);
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
  std::signal(SIGINT, [](int) { interrupt_requested = 1; });
  std::signal(SIGTERM, [](int) { interrupt_requested = 1; });
  StabilityEvents events;
  events.interrupted = [] { return interrupt_requested != 0; };
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

void list(const std::string& what) {
  const auto heading = [&](const char* name) {
    if (what.empty()) std::cout << (name == std::string("solvers") ? "" : "\n") << name << '\n';
    return what.empty() || what == name;
  };
  if (heading("solvers")) {
    for (const auto& backend : inextensible::backends()) {
      std::cout << "  " << backend.name << ": " << backend.summary << '\n';
      for (const auto& setting : backend.settings) {
        std::cout << "      " << setting.name << " = ";
        std::visit([](const auto& value) { std::cout << value; }, setting.initial);
        std::cout << "  (" << setting.meaning << ")\n";
      }
    }
  }
  if (heading("scenes")) {
    for (const auto& type : scene_types()) {
      std::cout << "  " << type.name << ": " << type.summary << '\n';
      for (const auto& parameter : type.parameters) {
        std::cout << "      " << parameter.name << " = " << parameter.initial << "  ("
                  << parameter.meaning << ")\n";
      }
    }
  }
  if (what == "cases") {
    for (const HardCase& c : hard_cases(hard_case_values("paper")))
      std::cout << "  " << c.name << " (" << c.row << "): " << c.what << '\n';
  }
  if (heading("suites")) {
    for (const std::string& name : profiles()) {
      const Suite suite = read_suite(source_path("configs/" + name + ".json"));
      std::cout << "  " << name << ": " << suite.description << '\n';
    }
  }
}

void list_points(const Options& options) {
  for (const Search& search : plan(load_suite(options), make_filters(options))) {
    PointSpec spec = search.base;
    for (const double step : search.ladder) {
      spec.step = step;
      std::cout << spec.id() << '\n';
    }
  }
}

int run(int argc, char** argv) {
  CLI::App app{
      "bench: which solver keeps cloth and chains from stretching fastest, at which strain, at "
      "which size.\n"
      "\n"
      "  bench --sweep strain                     Figures 4a and 5a of Goldenthal et al. 2007, in "
      "under 5 minutes\n"
      "  bench --sweep resolution --scene chain   Figure 4b\n"
      "  bench --sweep strain --profile quick     a first look, in under a minute\n"
      "  bench plot RESULT.json                   draws the figures of a result file again\n"
      "  bench --sweep step --scene chain         time against error, and a table of time to reach "
      "an error\n"
      "  bench --sweep stability                  hard cases: which solver breaks where\n"
      "  bench reference                          the trajectories that errors are measured "
      "against\n"
      "  bench claims RESULT.json ...             the paper's claims, decided by measurements\n"
      "  bench list                               solvers, scenes and suites with their "
      "settings\n"};
  app.set_version_flag("--version", std::string("bench ") + version());
  Options options;
  const auto sweep_options = [&options](CLI::App& to) {
    to.add_option("--sweep", options.sweep, "axis: strain (limit), resolution, step or stability")
        ->type_name("AXIS");
    to.add_option("--scene", options.scene, "chain or drape; both if left out")->type_name("NAME");
    to.add_option("--solver", options.solver, "only solvers whose name matches, e.g. 'shake|icd'")
        ->type_name("REGEX");
    to.add_option("--filter", options.filter, "only points in whose id this is found")
        ->type_name("REGEX");
    to.add_option("--exclude", options.exclude, "without points in whose id this is found")
        ->type_name("REGEX");
    to.add_option("--profile", options.profile,
                  "quick (< 1 min), default (about 5 min) or paper (an hour and a half)")
        ->type_name("NAME");
    to.add_option("--config", options.config, "a suite of your own instead of a profile")
        ->type_name("FILE");
  };
  sweep_options(app);
  app.add_option("--out", options.out, "result file; default results/local/<profile>-<axis>.json")
      ->type_name("FILE");
  app.add_option("--reps", options.reps, "runs of each best point")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  app.add_option("--timeout", options.timeout, "seconds a point may take")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  app.add_option("--step", options.step,
                 "search (each solver's best step, default) or adaptive (one run from the coarsest "
                 "step, halved where the solver refuses it)")
      ->type_name("HOW");
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

  std::string plot_file, plot_out;
  CLI::App* plot = app.add_subcommand("plot", "draw the figures of a result file");
  plot->add_option("result", plot_file, "result file")->required()->type_name("RESULT.json");
  plot->add_option("--out", plot_out, "folder for the figures; default: beside the result")
      ->type_name("DIR");
  bool again = false;
  double finest = 0;
  CLI::App* references = app.add_subcommand(
      "reference",
      "compute the reference trajectories that a profile's sweeps are measured against");
  sweep_options(*references);
  references->add_flag("--again", again, "those that are there already, too");
  references->add_option("--finest", finest, "smallest step of step halving, s")
      ->check(CLI::PositiveNumber)
      ->type_name("S");
  std::vector<std::string> claim_files;
  bool markdown = false;
  CLI::App* claim_report =
      app.add_subcommand("claims", "the paper's claims C1 to C16, decided from result files");
  claim_report->add_option("results", claim_files, "result files")
      ->required()
      ->type_name("RESULT.json");
  claim_report->add_flag("--markdown", markdown, "a table for the README");
  std::string listed;
  CLI::App* lists = app.add_subcommand(
      "list",
      "show what there is: solvers, scenes, suites, cases or points (points: with --sweep)");
  lists
      ->add_option("what", listed,
                   "solvers, scenes, suites, cases or points; the first three if left out")
      ->type_name("WHAT");
  sweep_options(*lists);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::cerr << "bench: " << error.what() << " (see bench --help)\n";
    return usage_error;
  }
  if (*plot) {
    std::vector<std::string> arguments{plot_file};
    if (!plot_out.empty()) arguments.insert(arguments.end(), {"--out", plot_out});
    return draw(arguments);
  }
  if (*claim_report) return claims(claim_files, markdown);
  if (*references) return make_references(options, again, finest);
  if (*lists) {
    if (listed == "points") {
      list_points(options);
    } else if (listed.empty() || listed == "solvers" || listed == "scenes" || listed == "suites" ||
               listed == "cases") {
      list(listed);
    } else {
      throw unknown_name("list", listed, {"solvers", "scenes", "suites", "cases", "points"});
    }
    return success;
  }
  if (options.sweep.empty()) {
    std::cerr
        << "bench: nothing to do: give --sweep strain, resolution, step or stability (see bench "
           "--help)\n";
    return usage_error;
  }
  std::vector<std::string> command{"bench"};
  for (int i = 1; i < argc; ++i) {  // a result is no place for a machine's folders
    const std::filesystem::path argument(argv[i]);
    command.push_back(argument.is_absolute() ? argument.filename().string() : argument.string());
  }
  if (options.sweep == "stability") return stability(options, command);
  if (!options.hard_case.empty() || !options.values.empty())
    throw UsageError("--case and --values go with --sweep stability");
  return sweep(options, command);
}

}  // namespace
}  // namespace harness

int main(int argc, char** argv) {
  harness::use_one_thread();
  try {
    return harness::run(argc, argv);
  } catch (const harness::UsageError& error) {
    std::cerr << "bench: " << error.what() << '\n';
    return harness::usage_error;
  } catch (const std::exception& error) {
    std::cerr << "bench: internal error: " << error.what() << '\n';
    return harness::internal_error;
  }
}
