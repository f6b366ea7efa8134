// Verbs: how they declare their options, the list of them, and what they share.
#pragma once

#include <initializer_list>
#include <iostream>

#include "harness/run/sweep.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace harness {

using Words = std::vector<std::string>;
using Numbers = std::vector<double>;

std::optional<double> number_in(const std::string& text);  // none unless it is one number

// docs/using.md explains them.
enum ExitCode {
  success = 0,
  internal_error = 1,
  usage_error = 2,
  regression = 3,
  unexpected_outcome = 4,
  not_comparable = 5,
  cannot_decide = 6,
  interrupted_exit = 130
};

using Action = std::function<int(const Words& typed)>;  // returns an ExitCode

// A verb's options are added to it. The variables that they set must outlive the verb's run.
class Command {
 public:
  explicit Command(CLI::App* app = nullptr, std::string group = {})
      : app_(app), group_(std::move(group)) {}

  using Place = std::variant<std::reference_wrapper<std::string>, std::reference_wrapper<Words>,
                             std::reference_wrapper<Numbers>, std::reference_wrapper<double>,
                             std::reference_wrapper<int>, std::reference_wrapper<std::int64_t>>;

  // An option if the name begins with dashes, else a positional argument. `type`: the value's name
  // in the help. Numbers are separated by commas, and the bounds apply to each.
  void option(const std::string& name, Place place, const std::string& help,
              const std::string& type, const Bounds& bounds = {}) const;
  // One value each time, whereas option() with Words takes all words that follow.
  void repeatable(const std::string& name, Words& values, const std::string& help,
                  const std::string& type) const;
  // A regular expression; several, repeated or separated by commas, are alternatives.
  void alternatives(const std::string& name, std::string& value, const std::string& help) const;
  // "4G" is 4 GiB.
  void byte_count(const std::string& name, double& value, const std::string& help) const;
  void flag(const std::string& name, bool& value, const std::string& help) const;

  void require(std::initializer_list<const char*> names) const;
  // Options under a heading of their own in the help. one_typed(): one that was given, or "".
  Command group(const std::string& heading) const { return Command(app_, heading); }
  const std::string& heading() const { return group_; }
  std::string one_typed() const;

 private:
  CLI::Option* placed(CLI::Option* option) const;

  CLI::App* app_;
  std::string group_;
};

// `add` adds the verb's options and returns its action.
struct Verb {
  std::string name, summary;
  Action (*add)(const Command& command);
  // It computes in child processes, and an interruption leaves a partial result.
  bool has_children = false;
};

// The action of a verb as a struct: declare() adds its options, run() acts, maybe on typed words.
template <class Options>
Action verb(const Command& command) {
  const auto options = std::make_shared<Options>();
  options->declare(command);
  return [options](const Words& typed) {
    if constexpr (requires { options->run(typed); })
      return options->run(typed);
    else
      return options->run();
  };
}

// ---- The verbs, in the order of the program's help ----

// VERB(name, children, summary): NAME_verb() is defined in this folder; for children see
// Verb::has_children. The first one runs if no verb is given.
#define HARNESS_VERBS(VERB)                                                                       \
  VERB(sweep, true,                                                                               \
       "time over strain limit, resolution or step, or hard cases: bench --sweep AXIS")           \
  VERB(repeat, true,                                                                              \
       "time the best points of a result again, on another day or machine, and add the times")    \
  VERB(show, false,                                                                               \
       "print a result file: which method is fastest within each strain limit and error")         \
  VERB(plot, false,                                                                               \
       "redraw the figures of a result file, or of several pieces of one sweep together")         \
  VERB(report, false,                                                                             \
       "write a page that opens offline: findings, ranks, points, figures and claims")            \
  VERB(answers, true, "compare each solver with exact answers (orbits, oscillations, falls)")     \
  VERB(film, false, "render a scene as stills or a film, or export it for ParaView and Blender")  \
  VERB(choose, false, "recommend a solver and a step for a scene, after a minute of measuring")   \
  VERB(check, false, "test what every solver must fulfil, and say where to look if one does not") \
  VERB(claims, false, "decide the paper's claims from result files")                              \
  VERB(results, false, "write tables of result files in Markdown (docs/results.md)")              \
  VERB(compare, false,                                                                            \
       "compare two results point by point: what is slower, less accurate or fails now")          \
  VERB(baseline, false, "reduce results to a file without times, to compare with later")          \
  VERB(ab, false, "compare the speed of two builds in interleaved pairs of runs")                 \
  VERB(tune, true,                                                                                \
       "search the settings of each solver, by one rule, on scenes that no result reports")       \
  VERB(reference, false, "compute the trajectories that errors are measured against")             \
  VERB(export, false, "write a scene as files for other programs: OBJ, JSON and NumPy arrays")    \
  VERB(mesh, false, "describe and draw a mesh of your own, and what becomes of it as cloth")      \
  VERB(judge, false, "judge the motion that another program made of an exported scene")           \
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

// ---- Options that several verbs share. Invalid values throw UsageError ----

// standard: the default that the help names, here and below.
struct SceneOptions {
  std::string scene;
  Numbers n;
  Words set;                                // NAME=NUMBER
  std::map<std::string, std::string> mesh;  // its parts (with_mesh_parts) but its bodies
  Words body, body_then;
  int least_n = 2;  // of --n

  // standard: the default that the help names; "": the scene is a mesh as it is.
  void declare(const Command& to, const std::string& standard);
  std::string name() const;                     // with what belongs to a mesh
  SceneParameters given_parameters() const;     // from --set
  SceneParameters complete_parameters() const;  // for a single scene and size
};

// A sweep: what selects its runs, and how they are run.
struct SweepOptions : SceneOptions {
  std::string sweep, solver, filter, exclude, config, profile = "default", steps = "search";
  Numbers limits;  // like n, instead of the suite's
  int reps = 0;
  double timeout = 0, finest_error = 0, finest = 0;
  std::int64_t seed = -1;
  bool untimed = false;  // need not wait for other programs that take times

  // The second adds to the first. of_suites: options that hard cases do not have.
  void declare_scenes(const Command& to, const Command& of_suites);
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
// Both: none for "". Each alternative of a solver pattern must match a solver or contestant.
std::optional<Pattern> solver_pattern(const std::string& text, const Contestants& contestants = {});
std::optional<Pattern> pattern_of(const std::string& option, const std::string& text);

std::string suite_path(const SweepOptions& options);
Suite load_suite(const SweepOptions& options);
SweepFilters filters_of(const SweepOptions& options);
// Scenes of the plan that have no reference, hence no trajectory errors, by the reference's file.
using SceneOfReference = std::pair<std::string, SceneParameters>;
std::map<std::string, SceneOfReference> without_reference(const std::vector<Search>& searches,
                                                          ReferenceFolder& references);
// Its methods, and how long the motion is known.
std::string reference_text(const Reference& reference);

// ---- Progress and output of long runs ----

// On a terminal one line that is rewritten; in logs about twenty lines for each part.
class Progress {
 public:
  Progress() = default;
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void begin_part();  // `fraction` and the remaining time refer to it
  void show(double fraction, const std::string& head, const std::string& text = {});
  void show(std::size_t done, std::size_t all, const std::string& text);  // "3 of 10"
  void clear();

 private:
  using Time = std::chrono::steady_clock::time_point;
  const bool terminal_ = isatty(STDERR_FILENO) == 1;
  Time start_ = std::chrono::steady_clock::now(), part_ = start_;
  int lines_ = 0;          // logged in this part
  std::size_t width_ = 0;  // of the terminal's line
};

RunEvents journaled_events(Journal& journal, Progress& progress);

struct OutputOptions {
  std::string out;
  bool resume = false, force = false, no_plots = false;

  void declare(const Command& to, const std::string& standard);
};

// The first free of results/local/<stem><ending>, <stem>-2<ending> and so on. last: the last that
// exists, unless an unfinished run follows it.
std::string default_output(const std::string& stem, const std::string& ending, bool last = false);

struct Finished {
  json document = nullptr;  // null: there is nothing to write
  bool complete = true;     // false: interrupted
  int code = success;       // if complete
};

// A run that can be interrupted and resumed.
struct Undertaking {
  std::string stem;     // of the default output's name
  json context, suite;  // must agree with a resumed run's (identity())
  const char* rows;     // the list of results in its file: "points", "matrix" or "rows"
  const char* what;     // the same in messages
  // Runs what the journal lacks. before: context of the resumed run, or null.
  std::function<Finished(Journal& journal, const json& before)> run;
  std::function<void(const json& result, Journal&)> add = [](auto&&...) {};
  std::function<std::size_t(const Journal&)> count = [](const Journal& j) {
    return j.known().size();
  };
};

// Writes to --out or results/local/<stem>.json and draws the figures; returns an ExitCode. --resume
// continues from an earlier run's journal or else its result. Throws UsageError, naming the options
// that help, for files that must not be replaced without them. An interrupted run writes a partial
// result, but never over a complete one.
int carry_out(const OutputOptions& options, const Undertaking& undertaking);

// ---- Figures, films and reports, drawn by the scripts of plots/ ----

// Runs a script of plots/ with an --out in a temporary folder, and returns its exit code. If that
// is 0, each file is moved atomically into the folder of `out` and named on stdout.
int draw(const std::string& script, const Words& arguments, const std::string& out);

bool is_sweep(const json& document);  // over strain, resolution or step

// A result as text, as wide as the terminal. name: in hints. all: every contestant, and failures.
std::string text_of_result(const json& document, const std::string& name, bool all = false);

// A result as plots/ reads it: a sweep with its analysis. Throws UsageError if it is untimed.
json with_analysis(json document);

// Figures of a result, whose names begin with `name`. folder: "" is the current one.
int draw_figures(json document, const std::string& name, const std::string& folder,
                 bool all = false);

}  // namespace harness
