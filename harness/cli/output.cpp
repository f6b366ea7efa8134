#include <fstream>
#include <set>

#include "harness/answers/answer.h"
#include "harness/base/child_process.h"
#include "harness/claims/claims.h"
#include "harness/cli/command.h"
#include "harness/points/context.h"
#include "harness/tables/tables.h"

namespace harness {
namespace {

namespace fs = std::filesystem;

bool exists(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

// What must agree for one run to continue another. context: machine_context() and "selection".
json identity(const json& context, const json& suite) {
  const json& build = context.at("build");
  return {{"processor", context.at("cpu_model")},
          {"compiler", build.at("compiler")},
          {"compiler flags", build.at("flags")},
          {"program", build.value("binary", build.at("git").get<std::string>())},
          {"libraries", context.at("libraries")},
          {"plug-ins", context.value("plugins", json::array())},
          {"suite", suite},
          {"selection", context.value("selection", json::object())}};
}

void check_same(const OutputOptions& options, const std::string& path, const json& was,
                const json& mine) {
  const std::string what = was.is_null() || options.force ? "" : difference(was, mine);
  if (!what.empty())
    throw UsageError("'" + path + "' is of another build or selection: " + what +
                     "; --resume --force continues nevertheless");
}

// The context of the run that this one continues, or null. None: that result is complete already.
std::optional<json> begin_journal(const OutputOptions& options, const std::string& out,
                                  Journal& journal, const Undertaking& run) {
  const json mine = identity(run.context, run.suite);
  const json header = {
      {"schema", "inextensible-journal/2"}, {"identity", mine}, {"context", run.context}};
  const std::size_t count = run.count(journal);
  const std::string entries = std::to_string(count) + " " + run.what;
  if (!options.force && !journal.damage().empty())
    throw UsageError("'" + journal.path() + "' is damaged, " + journal.damage() +
                     "; --resume --force continues with the " + entries +
                     " that can be read, --force starts again");
  if (!options.force && count > 0 && !options.resume)
    throw UsageError("'" + journal.path() + "' has " + entries +
                     " of a run that did not finish: --resume continues it, --force starts again");
  if (options.resume && count > 0) {
    const json was = journal.header().is_object() ? journal.header() : json::object();
    check_same(options, journal.path(), was.value("identity", json()), mine);
    journal.go_on(header);
    return was.value("context", json());
  }
  if (options.resume && exists(out)) {
    const json result = read_result(out, ResultKinds::all);
    if (!result.contains(run.rows))
      throw UsageError("'" + out + "' is the result of another kind of sweep: nothing to resume");
    const json& context = result.at("context");
    check_same(options, out, identity(context, context.value("suite", json())), mine);
    if (result.at("complete").get<bool>()) return std::nullopt;
    journal.start(header);
    run.add(result, journal);
    return context;
  }
  if (!options.force && exists(out))
    throw UsageError(
        "'" + out +
        "' exists: --force replaces it, --resume completes it, and another --out keeps both");
  journal.start(header);
  return json();
}

// A partial result replaces only another partial result.
bool takes_a_part(const std::string& out) {
  if (!exists(out)) return true;
  std::ifstream file(out);
  const json there = json::parse(file, nullptr, false);
  return there.is_object() && there.value("complete", json()) == false;
}

}  // namespace

void Progress::begin_part() {
  part_ = std::chrono::steady_clock::now();
  lines_ = 0;
}

void Progress::show(double fraction, const std::string& head, const std::string& text) {
  constexpr int most_lines = 20;
  if (!terminal_ && fraction * most_lines < lines_) return;
  std::string line = head + ", " + duration_text(since(start_));
  if (fraction > 0.02 && fraction < 1)
    line += ", about " + duration_text(since(part_) * (1 - fraction) / fraction) + " left";
  if (!text.empty()) line += ": " + text;
  if (!terminal_) {
    ++lines_;
    std::cerr << line << std::endl;
    return;
  }
  constexpr std::size_t cells = 12;
  const auto filled = std::min(static_cast<std::size_t>(fraction * cells), cells);
  line = "[" + std::string(filled, '#') + std::string(cells - filled, '.') + "] " + line;
  line.resize(std::min(line.size(), output_columns(STDERR_FILENO) - 1));  // a full one scrolls
  clear();
  width_ = line.size();
  std::cerr << line << std::flush;
}

void Progress::show(std::size_t done, std::size_t all, const std::string& text) {
  show(static_cast<double>(done) / static_cast<double>(all),
       std::to_string(done) + " of " + std::to_string(all), text);
}

void Progress::clear() {
  if (width_ > 0) std::cerr << "\r\033[K" << std::flush;
  width_ = 0;
}

RunEvents journaled_events(Journal& journal, Progress& progress) {
  RunEvents events;
  events.interrupted = interrupted;
  events.once = [&journal](const auto& key, const auto& compute) {
    return journal.once(key, compute);
  };
  events.done = [&progress](const std::string& key, std::size_t done, std::size_t all) {
    if (all > 0) return progress.show(done, all, key);
    progress.clear();
    std::cerr << key << '\n';
  };
  return events;
}

void OutputOptions::declare(const Command& to, const std::string& standard) {
  to.option("--out", out, "result file; default: results/local/" + standard, "FILE");
  to.flag("--resume", resume, "continue an interrupted run of the same --out");
  to.flag("--force", force,
          "replace an old result or run; with --resume: continue that of another build or suite");
  to.flag("--no-plots", no_plots, "draw no figures");
}

std::string default_output(const std::string& stem, const std::string& ending, bool last) {
  const auto numbered = [&](int i) {
    return local_result(stem + (i == 1 ? "" : "-" + std::to_string(i)) + ending);
  };
  int free = 1;
  while (exists(numbered(free))) ++free;
  return numbered(last && free > 1 && !exists(numbered(free) + ".journal") ? free - 1 : free);
}

int carry_out(const OutputOptions& options, const Undertaking& undertaking) {
  const std::string out = options.out.empty() ? default_output(undertaking.stem, ".json",
                                                               options.resume || options.force)
                                              : regular_output_path(options.out);
  check_writable(out);
  Journal journal(out);
  const std::optional<json> before = begin_journal(options, out, journal, undertaking);
  if (!before) {
    std::cout << out << " is complete already\n";
    return success;
  }
  Finished done;
  try {
    done = undertaking.run(journal, *before);
  } catch (const UsageError&) {
    if (undertaking.count(journal) == 0) journal.remove();  // refused before any result
    throw;
  }
  const bool written = !done.document.is_null() && (done.complete || takes_a_part(out));
  if (written) write_atomically(out, result_text(done.document));
  if (!done.document.is_null()) std::cout << text_of_result(done.document, out);
  if (written) std::cout << "\nwritten:\n" << out << std::endl;
  if (!done.complete) {
    if (!written && exists(out)) std::cerr << "bench: '" << out << "' stays as it was\n";
    std::cerr << "bench: interrupted; the same command with --resume continues from here\n";
    return interrupted_exit;
  }
  journal.remove();
  const fs::path file(out);
  if (!options.no_plots && draw_figures(read_result(out, ResultKinds::all), file.stem().string(),
                                        file.parent_path().string()) != 0)
    std::cerr << "bench: the figures could not be drawn\n";
  return done.code;
}

int draw(const std::string& script, const Words& arguments, const std::string& out) {
  const TemporaryFolder scratch("draw");
  const fs::path place(out);
  Words words{"/usr/bin/python3", source_path("plots/" + script)};
  words.insert(words.end(), arguments.begin(), arguments.end());
  words.insert(words.end(), {"--out", scratch.file(place.filename().string())});
  const ProgramResult ran = run_program(words, std::numeric_limits<double>::infinity());
  std::cerr << ran.err;
  if (ran.exit_code == 127)
    std::cerr
        << "bench: figures need /usr/bin/python3 with matplotlib (Debian: python3-matplotlib)\n";
  if (ran.exit_code != 0) return ran.exit_code;
  std::error_code error;
  fs::create_directories(place.parent_path(), error);
  const fs::directory_iterator drawn(scratch.path());
  for (const fs::path& file : std::set<fs::path>(begin(drawn), end(drawn))) {
    const std::string to = (place.parent_path() / file.filename()).lexically_normal().string();
    write_atomically(to, read_file(file.string(), "drawing"));
    std::cout << to << std::endl;
  }
  return success;
}

bool is_sweep(const json& document) { return document.at("schema") == "inextensible-bench/1"; }

std::string text_of_result(const json& document, const std::string& name, bool all) {
  std::ostringstream text;
  if (is_answers(document))
    print_answers(text, document);
  else if (is_sweep(document))
    print_sweep(text, document, name, all);
  else
    print_outcomes(text, document);
  return fitted(text.str(), output_columns());
}

json with_analysis(json document) {
  if (is_sweep(document)) {
    check_timed(document);
    document["analysis"] = analysis::analysis_of(document);
  }
  return document;
}

int draw_figures(json document, const std::string& name, const std::string& folder, bool all) {
  const TemporaryFolder scratch("figures");
  write_atomically(scratch.file(name + ".json"), with_analysis(std::move(document)).dump());
  Words arguments{scratch.file(name + ".json")};
  if (all) arguments.emplace_back("--all");
  return draw("figures.py", arguments, (fs::path(folder) / "").string());
}

}  // namespace harness
