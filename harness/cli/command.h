// What verbs have in common, and the list of them.
#pragma once

#include <unistd.h>

#include <chrono>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/journal.h"
#include "harness/base/json.h"
#include "harness/base/small_runs.h"
#include "harness/base/text.h"
#include "harness/cli/command_line.h"
#include "harness/points/contestant.h"
#include "harness/run/sweep.h"
#include "harness/scenes/scene.h"

namespace harness {

// ---- The verbs, in the order of the program's help ----

// VERB(name, children, summary): a file of this folder has NAME_verb(). A verb with children
// computes in them, and answers an interruption with what was done until then. The first one is
// what the program does without a verb.
#define HARNESS_VERBS(VERB)                                                                       \
  VERB(sweep, true,                                                                               \
       "time over strain limit, resolution or step, or hard cases: bench --sweep AXIS")           \
  VERB(show, false,                                                                               \
       "print a result file: which method is fastest within each strain limit and error")         \
  VERB(plot, false,                                                                               \
       "draw the figures of a result file again; of several pieces of one sweep as one")          \
  VERB(report, false,                                                                             \
       "write one page, to open offline: findings, ranks, points, figures and claims")            \
  VERB(answers, true, "compare each solver with exact answers (orbits, oscillations, falls)")     \
  VERB(film, false, "render a scene as stills or a film, or export it for ParaView and Blender")  \
  VERB(choose, false, "recommend a solver and a step for a scene, after a minute of measuring")   \
  VERB(check, false, "test what every solver must fulfil, and say where to look if one does not") \
  VERB(budget, false, "strain and error of each method within a frame budget")                    \
  VERB(claims, false, "decide the paper's claims from result files")                              \
  VERB(results, false, "write tables of result files in Markdown (docs/results.md)")              \
  VERB(compare, false,                                                                            \
       "compare two results point by point: what is slower, less accurate or fails now")          \
  VERB(baseline, false, "reduce results to a file without times, to compare with later")          \
  VERB(ab, false, "compare the speed of two builds in interleaved pairs of runs")                 \
  VERB(tune, true,                                                                                \
       "search the settings of each solver, by one rule, on scenes that no result reports")       \
  VERB(reference, false, "compute the trajectories that errors are measured against")             \
  VERB(point, false, "run single points, given as JSON on standard input, one a line")            \
  VERB(list, false, "print what there is: solvers, scenes, suites, verbs, cases and more")

#define HARNESS_DECLARE(name, children, summary) Action name##_verb(const Command& command);
HARNESS_VERBS(HARNESS_DECLARE)
#undef HARNESS_DECLARE

inline std::vector<Verb> verbs() {
#define HARNESS_ROW(name, children, summary) {#name, summary, name##_verb, children},
  return {HARNESS_VERBS(HARNESS_ROW)};
#undef HARNESS_ROW
}

// ---- Options that several verbs have: each has one name, one grammar and one help ----
//
// What they are about is checked here, and what is wrong is a UsageError.

// standard: what is taken if the option is not given, here and below.
struct SceneOptions {
  std::string scene;
  Numbers n;
  Words set;               // NAME=NUMBER
  std::string pins, body;  // of a mesh

  void declare(const Command& to, const std::string& standard);
  std::string name() const;                     // of the scene, with the parts of a mesh
  SceneParameters given_parameters() const;     // of --set
  SceneParameters complete_parameters() const;  // where one scene of one size is chosen
};

// A sweep: what selects its runs, and how they are run.
struct SweepOptions : SceneOptions {
  std::string sweep, solver, filter, exclude, config, profile = "default", steps = "search";
  Numbers limits;  // like n, instead of the suite's
  int reps = 0;
  double timeout = 0, finest_error = 0, finest = 0;
  std::int64_t seed = -1;
  bool untimed = false;  // times are not used: does not wait for others that take times

  // Each adds to the one before. of_suites: options that hard cases do not have.
  void declare_scenes(const Command& to, const Command& of_suites);
  void declare_selection(const Command& to, const Command& of_suites);
  void declare(const Command& to, const Command& of_suites);
};

void add_results(const Command& to, Words& files, const std::string& help);
void add_solver(const Command& to, std::string& solver);
void add_limits(const Command& to, Numbers& limits, const std::string& standard);
void add_filters(const Command& to, std::string& filter, std::string& exclude);
void add_suite(const Command& to, const Command& of_suites, std::string& profile,
               std::string& config);
void add_timeout(const Command& to, double& timeout, const std::string& standard);
void add_no_wait(const Command& to, bool& no_wait);

std::vector<std::string> profiles();
// Both: none for "". Each alternative of the first must match the name of some solver or of some
// contestant.
std::optional<Pattern> solver_pattern(const std::string& text, const Contestants& contestants = {});
std::optional<Pattern> pattern_of(const std::string& option, const std::string& text);

std::string suite_path(const SweepOptions& options);
Suite load_suite(const SweepOptions& options);
SweepFilters filters_of(const SweepOptions& options);
// Scenes of the plan without a reference, by its file's name: their points carry no trajectory
// error.
using SceneOfReference = std::pair<std::string, SceneParameters>;
std::map<std::string, SceneOfReference> without_reference(const std::vector<Search>& searches,
                                                          ReferenceFolder& references);
// The methods that made it, and for how long the motion is known.
std::string reference_text(const Reference& reference);

// ---- What a long run shows while it lasts and leaves when it ends ----

// On a terminal one line, rewritten; otherwise, for logs, some twenty lines for each part.
class Progress {
 public:
  Progress() = default;
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void begin_part();  // what `fraction` and the time that is left are of
  void show(double fraction, const std::string& head, const std::string& text = {});
  void show(std::size_t done, std::size_t all, const std::string& text);  // "3 of 10"
  void clear();

 private:
  using Time = std::chrono::steady_clock::time_point;
  const bool terminal_ = isatty(STDERR_FILENO) == 1;
  Time start_ = std::chrono::steady_clock::now(), part_ = start_;
  int lines_ = 0;          // of the log, in this part
  std::size_t width_ = 0;  // of the line on the terminal
};

// Events of small runs that a journal keeps and `progress` shows.
RunEvents journaled_events(Journal& journal, Progress& progress);

struct OutputOptions {
  std::string out;
  bool resume = false, rerun_failed = false, force = false, no_plots = false;

  void declare(const Command& to, const std::string& standard);
};

// results/local/<stem><ending>; where that exists, <stem>-2<ending> and so on. last: the last that
// exists, unless an unfinished run follows it.
std::string default_output(const std::string& stem, const std::string& ending, bool last = false);

struct Finished {
  nlohmann::json document = nullptr;  // null: there is nothing to write
  bool complete = true;               // false: interrupted
  int code = success;                 // of a complete one
};

// What is run: what must agree with the run that it goes on with, and how its results are kept.
struct Undertaking {
  std::string stem;               // of the default output
  nlohmann::json context, suite;  // with context.selection: what must agree (identity())
  const char* rows;               // the list of results in its file: "points", "matrix" or "rows"
  const char* what;               // these are, for messages
  // Runs what the journal does not know. before: context of the run that it continues, or null.
  std::function<Finished(Journal& journal, const nlohmann::json& before)> run;
  // Adds the results of a file to the journal.
  std::function<void(const nlohmann::json& result, Journal&)> add = [](auto&&...) {};
  // Results in a journal.
  std::function<std::size_t(const Journal&)> count = [](const Journal& j) {
    return j.known().size();
  };
};

// Runs it into --out or results/local/<stem>.json, and draws the figures; an ExitCode. --resume and
// --rerun-failed continue what an earlier run has left in the journal or else in its result. Throws
// UsageError, with the options that would help, for what is there and not to be touched without
// them. An interrupted run leaves its part of the result, but never in place of a whole one.
int carry_out(const OutputOptions& options, const Undertaking& undertaking);

// ---- Figures, films and reports, drawn by the scripts of plots/ ----

// Runs a script of plots/ with these arguments and an --out in a folder of its own. What it has
// written takes its place in the folder of `out`, file by file and each whole, and is named on
// stdout. Its exit code; where that is not 0, nothing is touched.
int draw(const std::string& script, const Words& arguments, const std::string& out);

bool is_sweep(const nlohmann::json& document);  // over strain, resolution or step

// A result for people, as wide as the terminal. name: what hints call it. all: of a sweep every
// contestant too, and how runs failed.
std::string text_of_result(const nlohmann::json& document, const std::string& name,
                           bool all = false);

// A result as plots/ reads it: a sweep with its analysis. Throws UsageError where nothing was
// timed.
nlohmann::json with_analysis(nlohmann::json document);

// The figures of a result, whose names begin with `name`. folder: "" for the one that we are in.
int draw_figures(nlohmann::json document, const std::string& name, const std::string& folder);

}  // namespace harness
