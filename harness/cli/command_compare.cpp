// bench compare, baseline, ab and point: two results point by point, a result for the next
// comparisons, two builds of this program timed against each other, and single points for these.
#include "harness/base/child_process.h"
#include "harness/base/timing_lock.h"
#include "harness/cli/command.h"
#include "harness/compare/comparison.h"
#include "harness/points/context.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  std::string gate;

  void declare(const Command& to) {
    to.option("--gate", gate, "what passes; default: configs/gate.json", "FILE");
  }

  Gate given_gate() const {
    return read_gate(gate.empty() ? source_path("configs/gate.json") : gate);
  }

  // Returns the exit code: a failure outranks a regression. undecided: message for ambiguous times.
  static int report(const Comparison& comparison, const std::string& undecided) {
    print_comparison(std::cout, comparison);
    if (comparison.any(is_failure)) return unexpected_outcome;
    if (comparison.any(is_regression)) return regression;
    if (!comparison.undecided()) return success;
    std::cerr << "bench: " << undecided << '\n';
    return cannot_decide;
  }
};

struct Compare : CompareOptions {
  std::string base;
  Words next;

  void declare(const Command& command) {
    command.option("base", base, "result file or baseline", "BASE.json");
    command.option("new", next, "result files; several count as one", "NEW.json");
    command.require({"base", "new"});
    CompareOptions::declare(command);
  }

  int run() {
    const Gate passes = given_gate();
    const ComparedResult before = read_compared({base}), after = read_compared(next);
    try {
      return report(
          compare(before, after, passes),
          "times of best points differ, but too few runs or too noisy a machine leave open whether "
          "that is noise: take more --reps, or use bench ab, which times in pairs");
    } catch (const NotComparable& reason) {
      std::string hint = "; a new baseline: bench baseline";
      for (const std::string& file : next) hint += " " + file;
      throw NotComparable(reason.what() + hint + " --out " +
                          (before.baseline ? base : "baseline.json"));
    }
  }
};

struct Baseline {
  Words files;
  std::string out;

  void declare(const Command& command) {
    add_results(command, files, "result files");
    command.option("--out", out, "the baseline", "FILE");
    command.require({"--out"});
  }

  int run() {
    const ComparedResult result = read_compared(files);
    if (result.baseline)
      throw UsageError("'" + result.path + "' is not a result file; a baseline is made from one");
    if (!result.complete)
      throw UsageError("'" + result.path +
                       "' comes from an interrupted run and cannot be a baseline");
    check_writable(out);
    write_atomically(out, document_text(baseline_document(result)));
    std::cout << out << ": " << counted(result.points.size(), "point") << std::endl;
    return success;
  }
};

// ---- Two builds ----

constexpr double run_timeout = 60, sweep_timeout = 3600;  // s

// A name without a folder is a file in the current folder, else this program, else one on the PATH.
std::string program_named(const std::string& name) {
  if (name.find('/') == std::string::npos && fs::exists(name)) return "./" + name;
  const fs::path own = fs::read_symlink("/proc/self/exe");
  return own.filename() == name ? own.string() : name;
}

// One of the two programs, with its plug-ins.
struct Program {
  std::string path;
  Words plugins;

  ProgramResult run(const Words& arguments, double timeout = run_timeout,
                    const std::string& input = "") const {
    Words words{path};
    for (const std::string& file : plugins) words.insert(words.end(), {"--plugin", file});
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run_program(words, timeout, input);
  }

  // Throws unless this is a bench that has `point` and loads its plug-ins.
  void check() const {
    const ProgramResult help = Program{path, {}}.run({"point", "--help"});
    if (help.exit_code == 127) throw UsageError("'" + path + "' is not a program");
    if (help.exit_code != success || help.out.find("--samples") == std::string::npos)
      throw NotComparable("'" + path +
                          "' has no command `point`, which times single points: it was built from "
                          "a commit before that");
    if (plugins.empty()) return;
    const ProgramResult list = run({"list", "solvers"});
    if (list.exit_code != success) throw UsageError(own_words(list));
  }

  static std::string own_words(const ProgramResult& ran) {
    const std::string said = ran.last_error_line();
    return said.starts_with("bench: ") ? said.substr(7) : said;
  }
};

// A point that the process does not print has failed.
ComparedPoint run_one(const Program& program, const PairedPoint& point) {
  const ProgramResult ran =
      program.run({"point", "--samples", std::to_string(point.samples)},
                  run_timeout * (point.samples + 1), point.spec.dump() + "\n");
  const json printed = json::parse(ran.out, nullptr, false);
  if (ran.exit_code == success && printed.is_object()) return compared_point(printed);
  return {point.spec.at("sweep"), point.spec.at("id"),
          ran.timed_out                  ? "timeout"
          : ran.exit_code == usage_error ? "unsupported"
                                         : "crashed",
          ran.exit_code == success ? "printed no result: '" + shortened(ran.out, 60) + "'"
                                   : ran.last_error_line()};
}

struct Ab : CompareOptions {
  Program before, after;
  std::string profile = "quick", config, solver, scene, filter, exclude;
  int pairs = 15, confirming = 25;
  bool no_wait = false;
  // s a process. Long enough that one of many short runs is undisturbed and that starting the
  // process does not dominate.
  double least_measured = 0.05;

  void declare(const Command& command) {
    command.option("old", before.path, "the program before", "OLD");
    command.option("new", after.path, "the program after", "NEW");
    command.require({"old", "new"});
    command.repeatable("--old-plugin", before.plugins,
                       "a plug-in of the program before; repeatable", "FILE");
    command.repeatable("--new-plugin", after.plugins, "a plug-in of the program after; repeatable",
                       "FILE");
    add_suite(command, command, profile, config);
    const Bounds number_of_pairs{.least = 4, .most = 1000, .whole = true};  // fewer prove nothing
    command.option("--pairs", pairs, "processes of each build for a point; default: 15", "N",
                   number_of_pairs);
    command.option("--confirm", confirming, "pairs of the second look; default: 25", "N",
                   number_of_pairs);
    command.option("--sample-seconds", least_measured,
                   "least time that a process measures, in as many runs as needed; default: 0.05",
                   "S", {.least = 1e-3, .most = 60});
    add_solver(command, solver);
    command.option("--scene", scene, "one of the suite's; default: all", "SCENE");
    add_filters(command, filter, exclude);
    add_no_wait(command, no_wait);
    CompareOptions::declare(command);
  }

  // The best points of the old program, with the stiffness that it found, for both programs.
  std::vector<PairedPoint> best_points() const {
    const TemporaryFolder folder("ab");
    const std::string out = folder.file("old.json");
    Words words{"--sweep", "strain", "--reps", "1", "--no-plots", "--out", out};
    for (const auto& [option, value] :
         {config.empty() ? std::pair("--profile", profile) : std::pair("--config", config),
          std::pair("--solver", solver), std::pair("--scene", scene), std::pair("--filter", filter),
          std::pair("--exclude", exclude)})
      if (!value.empty()) words.insert(words.end(), {option, value});
    const ProgramResult ran = before.run(words, sweep_timeout);
    if (ran.exit_code == usage_error) throw UsageError(Program::own_words(ran));
    if (ran.exit_code != success)
      throw std::runtime_error("the sweep of '" + before.path +
                               "' did not end: " + ran.last_error_line());
    std::vector<PairedPoint> points;
    const json result = read_result(out);
    for (json point : result.at("points")) {
      if (!point.value("best", false)) continue;
      if (const json& options = point.at("options"); options.contains("stiffness"))
        point["settings"]["stiffness"] = options.at("stiffness");
      const double seconds = point.at("seconds_per_simulated_second").at("min").get<double>() *
                             point.at("duration").get<double>();
      const double runs = std::ceil(least_measured / std::max(seconds, least_sample));
      points.push_back({std::move(point), static_cast<int>(std::clamp(runs, 1.0, 1000.0))});
    }
    if (points.empty())
      throw NotComparable("'" + before.path + "' has no point that runs to its end");
    return points;
  }

  int run() {
    Gate passes = given_gate();
    // Without --gate, counters are reported but fail nothing: the question is about times.
    if (gate.empty()) {
      passes.counter_rule = CounterRule::inform;
      passes.errors.clear();
    } else if (!passes.times) {
      throw UsageError("gate '" + gate + "': bench ab is about times");
    }
    for (Program* program : {&before, &after}) {
      program->path = program_named(program->path);
      program->check();
    }
    const TimingLock lock(!no_wait);
    std::cerr << "looking for the best steps of " << before.path << " ..." << std::endl;
    std::vector<PairedPoint> points = best_points();
    // One run of each shows whether their counters are comparable.
    Comparability can;
    const std::string old_print = run_one(before, points.front()).fingerprint;
    if (old_print.empty() || old_print != run_one(after, points.front()).fingerprint)
      can.no_counters = "compiler, flags or libraries differ";
    std::cerr << counted(points.size(), "point") << ", " << pairs << " pairs each ..." << std::endl;
    Comparison comparison =
        compare_in_pairs(std::move(points), pairs, confirming, passes, can,
                         [this](Side side, const PairedPoint& point) {
                           return run_one(side == Side::old_one ? before : after, point);
                         });
    if (!can.counters()) comparison.notes.push_back("counters not compared: " + can.no_counters);
    return report(comparison,
                  "some points cannot be decided (AMBIGUOUS above): take more --pairs and "
                  "--sample-seconds, or a quieter machine");
  }
};

// ---- Single points, in this process ----

void check_spec(PointSpec& spec) {
  const auto type = checked_scene(spec.scene);
  const SceneParameters parameters = complete_parameters(*type, spec.scene_parameters);
  if (parameters != spec.scene_parameters)
    throw UsageError("'scene_parameters' is " + value_text(spec.scene_parameters) +
                     ", must hold every parameter of the scene: " + json(parameters).dump());
  std::tie(spec.vertices, spec.constraints) = type->counts(parameters);
  check_plain_name(spec.contestant, "'contestant'");
  check_settings(spec.settings, "'settings'", checked_backend(spec.solver, "'solver'"));
  if (!(spec.strain_limit > 0) || !std::isfinite(spec.strain_limit))
    throw UsageError("'strain_limit' is " + json(spec.strain_limit).dump() + ", must be above 0");
  const double duration = parameters.at("duration");
  if (!(spec.step > 0 && spec.step <= duration && duration / spec.step <= most_steps))
    throw UsageError("'step' is " + json(spec.step).dump() +
                     ", must be above 0 s and at most the duration, " + json(duration).dump() +
                     " s");
}

// One point a line; empty lines do not count. All are checked before the first one runs.
std::vector<PointSpec> read_specs(std::istream& in) {
  std::vector<PointSpec> specs;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string where = "point on line " + std::to_string(number);
    const json given = parse_document(line, where);
    try {
      // These may be omitted from a point that is typed by hand.
      json object{{"contestant", ""}, {"settings", json::object()}};
      object.update(given);
      check_spec(specs.emplace_back(spec_of(object)));
    } catch (const std::exception& error) {
      throw UsageError(where + ": " + error.what());
    }
  }
  if (specs.empty())
    throw UsageError("no point on standard input: give points of a result file, one JSON a line");
  return specs;
}

struct PointVerb {
  int samples = 1;
  RunLimits limits;

  void declare(const Command& command) {
    command.option("--samples", samples, "runs of each, the first one judged; default: 1", "N",
                   {.least = 1, .most = 1000000, .whole = true});
    add_timeout(command, limits.timeout, "60");
  }

  PointResult timed(const PointSpec& spec) const {
    const OutputToError no_output;  // a line printed by the solver would be read as a result
    PointResult point = run_point(spec, limits);
    for (int i = 1; i < samples && point.ok(); ++i) add_sample(point, run_point, limits);
    return point;
  }

  int run() {
    limits.references = ReferenceFolder::usual();
    const std::string fingerprint = counters_fingerprint();
    for (const PointSpec& spec : read_specs(std::cin)) {
      json line = to_json(timed(spec));
      line["counters_fingerprint"] = fingerprint;
      std::cout << compact(line) << std::endl;
    }
    return success;
  }
};

}  // namespace

Action compare_verb(const Command& command) { return verb<Compare>(command); }
Action baseline_verb(const Command& command) { return verb<Baseline>(command); }
Action ab_verb(const Command& command) { return verb<Ab>(command); }
Action point_verb(const Command& command) { return verb<PointVerb>(command); }

}  // namespace harness
