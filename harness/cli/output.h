// What a long run shows while it lasts and leaves when it ends: progress on standard error, one
// file of results, with a journal beside it until it is whole, and pictures.
#pragma once

#include <unistd.h>

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "harness/base/journal.h"
#include "harness/base/small_runs.h"
#include "harness/cli/command_line.h"

namespace harness {

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
