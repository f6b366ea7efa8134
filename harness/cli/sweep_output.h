// Where a result goes, and what may be there already.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "harness/base/journal.h"
#include "harness/base/small_runs.h"
#include "harness/cli/command_line.h"

namespace harness {

struct OutputOptions {
  std::string out;
  bool resume = false, rerun_failed = false, force = false;
};

// --resume and --force.
void add_output_rules(const Command& to, OutputOptions& options);

// Says how the run goes on, and gives its exit code.
int tell_interrupted();

// Where the result goes: to --out, a regular file, or to results/local/<stem>.json; or, where that
// has a finished result, to <stem>-2.json and so on, unless it is that one which is meant
// (--resume, --rerun-failed, --force). Throws UsageError.
std::string chosen_output(const OutputOptions& options, const std::string& stem);

// What a run is: what must agree with the run that it goes on with, and how its results are kept.
struct Undertaking {
  nlohmann::json identity, context;
  const char* rows;  // the list of results in its file: "points", "matrix" or "rows"
  const char* what;  // these are, for messages
  // Results in a journal.
  std::function<std::size_t(const Journal&)> count = [](const Journal& j) {
    return j.known().size();
  };
  // Adds those of a result file.
  std::function<void(const nlohmann::json& result, Journal&)> add = [](auto&&...) {};
};

// What was there before.
struct Past {
  bool finished = false;   // a whole result: nothing to do, and the journal is untouched
  nlohmann::json context;  // of the run that this one goes on with; null: there is none
};

// Begins the journal of the result `out`: with --resume or --rerun-failed it goes on with what an
// earlier run has left there or, where it left nothing, in its result. Throws UsageError, with the
// options that would help, for an unfinished run or a result that no option says what to do with,
// and, without --force, for one of another build or selection and for a damaged journal.
Past begin_journal(const OutputOptions& options, const std::string& out, Journal& journal,
                   const Undertaking& run);

// Events of small runs that a journal keeps, and whose progress standard error shows.
RunEvents journaled_events(Journal& journal);

}  // namespace harness
