// bench ab: two builds of this program timed against each other.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "harness/base/child_program.h"
#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/paths.h"
#include "harness/base/text.h"
#include "harness/base/timing_lock.h"
#include "harness/cli/compare_options.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/shared_options.h"
#include "harness/cli/verbs.h"
#include "harness/compare/pairs.h"
#include "harness/points/result_file.h"
#include "harness/run/measure_point.h"

namespace harness {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double point_timeout = 60;  // s, of one run
constexpr double sweep_timeout = 3600;

struct AbCommand : CompareOptions {
  std::string old_binary, new_binary, profile = "quick", config, solver, scene, filter, exclude;
  int pairs = 15, confirming = 25;
  bool no_wait = false;
  // s that a process measures at least, so that runs of a millisecond are seen often enough for one
  // of them to be undisturbed, and starting the process does not dominate.
  double least_measured = 0.05;

  std::vector<std::string> old_plugins, new_plugins;

  // The program of a side with its plug-ins, a command to be added.
  std::vector<std::string> program(Side side) const {
    std::vector<std::string> words{side == Side::old_one ? old_binary : new_binary};
    for (const std::string& file : side == Side::old_one ? old_plugins : new_plugins)
      words.insert(words.end(), {"--plugin", file});
    return words;
  }
};

ProgramResult run_or_interrupt(const std::vector<std::string>& words, const std::string& input,
                               double timeout) {
  ProgramResult result = run_program(words, input, timeout, interrupted);
  if (interrupted()) throw Interrupted();
  return result;
}

// A name without a folder is a file here, else a program on the PATH as for a shell, else, if it is
// its name, this program: an installed `bench ab bench bench` means itself.
std::string program_named(const std::string& name) {
  if (name.find('/') != std::string::npos || fs::exists(name)) return name;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder) / name;
    if (fs::is_regular_file(file) && access(file.c_str(), X_OK) == 0) return file.string();
  }
  const fs::path own = fs::read_symlink("/proc/self/exe");
  return own.filename() == name ? own.string() : name;
}

void check_binary(const std::string& path) {
  if (!fs::is_regular_file(path) || access(path.c_str(), X_OK) != 0)
    throw UsageError("'" + path + "' is no program");
  const ProgramResult help = run_or_interrupt({path, "point", "--help"}, "", point_timeout);
  if (help.exit_code != 0 || help.out.find("--samples") == std::string::npos)
    throw NotComparable("'" + path +
                        "' has no command `point`, which times single points: it was built from a "
                        "commit before that");
}

std::string without_program(const std::string& said) {
  return said.starts_with("bench: ") ? said.substr(7) : said;
}

// Plug-ins that cannot be loaded are told before anything is timed.
void check_plugins(const AbCommand& options, Side side) {
  std::vector<std::string> words = options.program(side);
  if (words.size() == 1) return;
  words.insert(words.end(), {"list", "solvers"});
  const ProgramResult list = run_or_interrupt(words, "", point_timeout);
  if (list.exit_code != success) throw UsageError(without_program(list.last_error_line()));
}

// What the old program finds best; the new one runs the same.
json old_result(const AbCommand& options) {
  const TemporaryFolder folder("ab");
  const std::string out = folder.file("old.json");
  std::vector<std::string> words = options.program(Side::old_one);
  words.insert(words.end(), {"--sweep", "strain"});
  for (const auto& [option, value] :
       {options.config.empty() ? std::pair("--profile", options.profile)
                               : std::pair("--config", options.config),
        std::pair("--solver", options.solver), std::pair("--scene", options.scene),
        std::pair("--filter", options.filter), std::pair("--exclude", options.exclude),
        std::pair("--out", out)}) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  }
  words.insert(words.end(), {"--reps", "1", "--no-plots"});
  const ProgramResult ran = run_or_interrupt(words, "", sweep_timeout);
  const std::string said = ran.last_error_line();
  if (ran.exit_code == usage_error) throw UsageError(without_program(said));
  if (ran.exit_code != success)
    throw std::runtime_error("the sweep of '" + options.old_binary + "' did not end: " + said);
  return read_result(out);
}

// A point of a result as what is to be run: with the stiffness that was found for it.
json spec_json(const json& point) {
  json spec;
  for (const char* key :
       {"sweep", "scene", "scene_parameters", "resolution", "vertices", "constraints", "contestant",
        "solver", "settings", "strain_limit", "step", "adaptive", "seed"}) {
    if (point.contains(key)) spec[key] = point.at(key);
  }
  const json& options = point.at("options");
  if (options.contains("stiffness")) spec["settings"]["stiffness"] = options.at("stiffness");
  return spec;
}

std::vector<PairedPoint> best_points(const json& result, double least_measured) {
  std::vector<PairedPoint> points;
  for (const json& point : result.at("points")) {
    if (!point.value("best", false)) continue;
    const double seconds = point.at("seconds_per_simulated_second").at("min").get<double>() *
                           point.at("duration").get<double>();
    PairedPoint paired;
    paired.spec = spec_json(point);
    paired.id = point.at("id");
    paired.samples = samples_for(std::max(seconds, least_sample), least_measured);
    points.push_back(std::move(paired));
  }
  return points;
}

// In place of a point that no process has printed.
json failed_point(const PairedPoint& point, const ProgramResult& ran) {
  json printed = point.spec;
  printed["id"] = point.id;
  printed["status"] = ran.timed_out                  ? "timeout"
                      : ran.exit_code == usage_error ? "unsupported"
                                                     : "crashed";
  printed["status_detail"] = ran.exit_code == success
                                 ? "printed no result: '" + shortened(ran.out, 60) + "'"
                                 : ran.last_error_line();
  printed["work"] = json::object();
  printed["max_strain"] = nullptr;
  printed["error"] = json::object();
  return printed;
}

json run_one(const AbCommand& options, Side side, const PairedPoint& point) {
  const double timeout = point_timeout * (point.samples + 1);
  std::vector<std::string> words = options.program(side);
  words.insert(words.end(), {"point", "--samples", std::to_string(point.samples)});
  const ProgramResult ran = run_or_interrupt(words, point.spec.dump() + "\n", timeout);
  json printed = json::parse(ran.out, nullptr, false);
  return ran.exit_code == success && printed.is_object() ? printed : failed_point(point, ran);
}

// Counters are told and fail nothing, unless a gate was asked for: here times are the question.
Gate gate_of(const AbCommand& options) {
  if (!options.gate.empty()) return read_gate(options.gate);
  Gate gate = read_gate(source_path("configs/gate.json"));
  gate.counter_rule = CounterRule::inform;
  gate.errors.clear();
  return gate;
}

// One process of each says whether their counters compare.
Comparability comparability_of(const AbCommand& options, const PairedPoint& point) {
  const auto fingerprint = [&](Side side) {
    return run_one(options, side, point)
        .value("counters_fingerprint", side == Side::old_one ? "" : "?");
  };
  Comparability can;
  if (fingerprint(Side::old_one) != fingerprint(Side::new_one))
    can.no_counters = "compiler, flags or libraries differ";
  return can;
}

int run_ab(const AbCommand& options) {
  const Gate gate = gate_of(options);
  if (!gate.times) throw UsageError("gate '" + options.gate + "': bench ab is about times");
  check_reports(options);
  catch_interrupts();
  try {
    check_binary(options.old_binary);
    check_binary(options.new_binary);
    check_plugins(options, Side::old_one);
    check_plugins(options, Side::new_one);
    const TimingLock lock(!options.no_wait);
    std::cerr << "looking for the best steps of " << options.old_binary << " ..." << std::endl;
    std::vector<PairedPoint> points = best_points(old_result(options), options.least_measured);
    if (points.empty())
      throw NotComparable("'" + options.old_binary + "' has no point that runs to its end");
    const Comparability can = comparability_of(options, points.front());
    std::cerr << points.size() << " points, " << options.pairs << " pairs each ..." << std::endl;
    const RunOne run = [&](Side side, const PairedPoint& point) {
      return run_one(options, side, point);
    };
    Comparison comparison =
        compare_in_pairs(std::move(points), options.pairs, options.confirming, gate, can, run);
    if (!can.counters()) comparison.notes.push_back("counters not compared: " + can.no_counters);
    return report_comparison(comparison, options, "bench ab",
                             "some points cannot be decided (AMBIGUOUS above): take more --pairs "
                             "and --sample-seconds, or a quieter machine");
  } catch (const NotComparable& reason) {
    std::cerr << "bench: " << reason.what() << '\n';
    return not_comparable;
  } catch (const Interrupted&) {
    return interrupted_exit;
  }
}

}  // namespace

Verb ab_verb() {
  return {
      "ab", "compare the speed of two builds in interleaved pairs of runs",
      [](const Command& command) -> Action {
        const auto given = std::make_shared<AbCommand>();
        AbCommand& options = *given;
        command.option("old", options.old_binary, "the program before", "OLD").required();
        command.option("new", options.new_binary, "the program after", "NEW").required();
        command
            .option("--old-plugin", options.old_plugins,
                    "a plug-in of the program before; repeatable", "FILE")
            .repeatable();
        command
            .option("--new-plugin", options.new_plugins,
                    "a plug-in of the program after; repeatable", "FILE")
            .repeatable();
        add_suite(command, options.profile, options.config);
        command
            .option("--pairs", options.pairs, "processes of each build for a point; default: 15",
                    "N")
            .within(4, 1000);  // fewer are never significant
        command
            .option("--confirm", options.confirming, "pairs of the second look; default: 25", "N")
            .within(4, 1000);
        command
            .option("--sample-seconds", options.least_measured,
                    "least time that a process measures, in as many runs as needed; default: 0.05",
                    "S")
            .within(1e-3, 60.0);
        add_solver(command, options.solver);
        command.option("--scene", options.scene, "one of the suite's; default: all", "SCENE");
        add_filters(command, options.filter, options.exclude);
        add_no_wait(command, options.no_wait);
        add_compare_options(command, options);
        return [given] {
          given->old_binary = program_named(given->old_binary);
          given->new_binary = program_named(given->new_binary);
          return run_ab(*given);
        };
      }};
}

}  // namespace harness
