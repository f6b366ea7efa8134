#include "harness/cli/sweep_output.h"

#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/paths.h"
#include "harness/cli/exit_codes.h"
#include "harness/points/context.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

using nlohmann::json;

bool exists(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

}  // namespace

void add_output_rules(const Command& to, OutputOptions& options) {
  to.flag("--resume", options.resume, "continue an interrupted run of the same --out");
  to.flag(
      "--force", options.force,
      "replace a result or an interrupted run; with --resume: continue a run of another build or "
      "suite");
}

int tell_interrupted() {
  std::cerr << "bench: interrupted; the same command with --resume continues from here\n";
  return interrupted_exit;
}

std::string chosen_output(const OutputOptions& options, const std::string& stem) {
  if (!options.out.empty()) return regular_output_path(options.out);
  const auto numbered = [&stem](int i) {
    return local_result(stem + (i == 1 ? "" : "-" + std::to_string(i)) + ".json");
  };
  int free = 1;
  while (exists(numbered(free))) ++free;
  const bool last = options.resume || options.rerun_failed || options.force;
  if (last && free > 1 && !exists(numbered(free) + ".journal")) --free;
  return numbered(free);
}

namespace {

// Whether what a journal holds may be taken up or dropped.
void check_unfinished(const OutputOptions& options, const Journal& journal,
                      const Undertaking& run) {
  const std::size_t count = run.count(journal);
  const std::string entries = std::to_string(count) + " " + run.what;
  if (options.force) return;
  if (!journal.damage().empty())
    throw UsageError("'" + journal.path() + "' is damaged, " + journal.damage() +
                     "; --resume --force continues with the " + entries +
                     " that can be read, --force starts again");
  if (count > 0 && !options.resume && !options.rerun_failed)
    throw UsageError("'" + journal.path() + "' has " + entries +
                     " of a run that did not finish: --resume continues it, --force starts again");
}

void check_same(const OutputOptions& options, const std::string& path, const json& was,
                const json& mine) {
  if (was.is_null() || options.force) return;
  const std::string what = difference(was, mine);
  if (!what.empty())
    throw UsageError("'" + path + "' is of another build or selection: " + what +
                     "; --resume --force continues nevertheless");
}

}  // namespace

Past begin_journal(const OutputOptions& options, const std::string& out, Journal& journal,
                   const Undertaking& run) {
  const bool again = options.resume || options.rerun_failed;
  const json header = {
      {"schema", "inextensible-journal/2"}, {"identity", run.identity}, {"context", run.context}};
  check_unfinished(options, journal, run);
  if (again && run.count(journal) > 0) {
    const json was = journal.header().is_object() ? journal.header() : json::object();
    check_same(options, journal.path(), was.value("identity", json()), run.identity);
    journal.go_on(header);
    return {false, was.value("context", json())};
  }
  if (again && exists(out)) {
    const json result = read_result_or_answers(out);
    if (!result.contains(run.rows))
      throw UsageError("'" + out + "' is the result of another kind of sweep: nothing to resume");
    const json& context = result.at("context");
    check_same(options, out,
               identity(context, context.value("suite", json()),
                        context.value("selection", json::object())),
               run.identity);
    if (result.at("complete").get<bool>() && !options.rerun_failed) return {true, context};
    journal.start(header);
    run.add(result, journal);
    return {false, context};
  }
  if (!options.force && exists(out))
    throw UsageError("'" + out +
                     "' exists: --force replaces it, --resume completes it, and another "
                     "--out keeps both");
  journal.start(header);
  return {};
}

RunEvents journaled_events(Journal& journal) {
  RunEvents events;
  events.interrupted = interrupted;
  events.once = [&journal](const auto& key, const auto& compute) {
    return journal.once(key, compute);
  };
  events.done = [terminal = isatty(STDERR_FILENO) == 1](const std::string& key, std::size_t done,
                                                        std::size_t all) {
    if (all == 0) {
      std::cerr << key << '\n';
    } else if (terminal) {
      std::cerr << "\r\033[K[" << done << '/' << all << "] " << key << (done == all ? "\n" : "");
    } else if (done % 100 == 0 || done == all) {
      std::cerr << '[' << done << '/' << all << "]\n";
    }
  };
  return events;
}

}  // namespace harness
