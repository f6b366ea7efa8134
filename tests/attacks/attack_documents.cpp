// Corrupted documents of every kind through everything that reads them: taken, or refused in a
// short line; nothing else.
//   attack_documents --seconds S --seed N SOURCES...
// SOURCES: good files, by name: suites, results, baselines, gates, tuned settings, references,
// journals. Prints one line of JSON: what was done, and the first failures. Exit code 1 if there
// are any.
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "harness/base/child_process.h"
#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/claims/claims.h"
#include "harness/compare/comparison.h"
#include "harness/judge/reference_file.h"
#include "harness/points/identity.h"
#include "harness/points/point_json.h"
#include "harness/points/result_file.h"
#include "harness/points/suite.h"
#include "harness/points/tuned.h"
#include "harness/run/journal.h"
#include "harness/run/merge.h"
#include "harness/run/sweep.h"
#include "harness/tables/results_page.h"
#include "support/corrupt.h"

namespace {

using harness::testing::corrupt;
using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr int batch = 200;                     // documents a child process
constexpr double most_seconds = 10;            // that one document may take
constexpr std::size_t most_characters = 1000;  // of a message

struct Source {
  std::string name, text;
  void (*read)(const Source& good, const std::string& text);
};

std::string scratch() {
  static const std::string path = [] {
    std::string name = (std::filesystem::temp_directory_path() / "attack-XXXXXX").string();
    if (!mkdtemp(name.data())) std::abort();
    return name;
  }();
  return path;
}

std::string written(const std::string& text) {
  std::string path = scratch() + "/document-" + std::to_string(getpid());
  std::ofstream(path, std::ios::trunc) << text;
  return path;
}

void read_suite(const Source& /*good*/, const std::string& text) {
  const harness::Suite suite = harness::parse_suite(text, "corrupted");
  (void)to_json(suite).dump();
  std::size_t points = 0;
  for (const harness::SweepSpec& s : suite.sweeps)
    points += s.limits.size() * s.resolutions.size() * s.contestants.size();
  if (points < 2000) (void)plan(suite, {});
}

void read_result(const Source& good, const std::string& text) {
  const json result = harness::parse_result(text, "corrupted");
  (void)harness::judge_claims({result});
  std::ostringstream page;
  harness::print_results_page(page, {{"corrupted", result}}, {});
  if (result.at("schema") != "inextensible-bench/1") return;
  (void)harness::merge({{"corrupted", result}}, {.partial = true});
  harness::Memory().learn(result);
  (void)harness::baseline_document({result});
  const harness::ComparedResult base = harness::read_compared({written(good.text)}),
                                next = harness::read_compared({written(text)});
  try {
    (void)compare(base, next, {});
  } catch (const harness::NotComparable&) {
  }
}

void read_answers(const Source& /*good*/, const std::string& text) {
  const json answers = harness::read_answers(written(text));
  std::ostringstream page;
  harness::print_results_page(page, {}, {}, {{"corrupted", answers}});
}

void read_baseline(const Source& good, const std::string& text) {
  const harness::ComparedResult next = harness::read_compared({written(text)}),
                                base = harness::read_compared({written(good.text)});
  try {
    (void)compare(base, next, {});
  } catch (const harness::NotComparable&) {
  }
}

void read_gate(const Source& /*good*/, const std::string& text) {
  (void)harness::parse_gate(text, "corrupted");
}

void read_tuned(const Source& /*good*/, const std::string& text) {
  (void)harness::parse_tuned(text, "corrupted");
}

void read_reference(const Source& /*good*/, const std::string& text) {
  (void)summary_of(harness::read_reference(written(text)));
}

void read_journal(const Source& /*good*/, const std::string& text) {
  const std::string out = scratch() + "/out-" + std::to_string(getpid());
  std::ofstream(out + ".journal", std::ios::trunc) << text;
  {
    harness::Journal journal(out);
    if (journal.header().is_object()) {
      (void)journal.header().at("identity").dump();
      (void)harness::difference(journal.header().at("identity"), journal.header().at("identity"));
    }
    for (const auto& [key, known] : journal.memory().points) (void)to_json(known.point).dump();
  }
  unlink((out + ".journal").c_str());
}

Source source_of(const std::string& path) {
  Source source{std::filesystem::path(path).filename().string(),
                harness::read_file(path, "document"), nullptr};
  if (path.ends_with(".journal")) {
    source.read = read_journal;
    return source;
  }
  const json document = json::parse(source.text, nullptr, true, true);
  const std::string schema = document.value("schema", "");
  source.read = schema.starts_with("inextensible-baseline")    ? read_baseline
                : schema.starts_with("inextensible-tuned")     ? read_tuned
                : schema.starts_with("inextensible-reference") ? read_reference
                : schema.starts_with("inextensible-answers")   ? read_answers
                : !schema.empty()                              ? read_result
                : document.contains("sweeps")                  ? read_suite
                                                               : read_gate;
  return source;
}

// What is wrong with how the reader took the text; "" if nothing is.
std::string defect(const Source& source, const std::string& text, bool& refused) {
  const auto start = Clock::now();
  std::string found;
  try {
    source.read(source, text);
  } catch (const harness::UsageError& error) {
    refused = true;
    const std::string message = error.what();
    if (message.size() > most_characters)
      found = "a message of " + std::to_string(message.size()) + " characters";
    if (message.find('\n') != std::string::npos) found = "a message of several lines: " + message;
  } catch (const std::exception& error) {
    found = std::string("got out: ") + error.what();
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (seconds > most_seconds) found = "took " + std::to_string(seconds) + " s";
  return found;
}

struct Figures {
  std::int64_t documents = 0, refused = 0;
  std::vector<std::string> failures;
};

// A batch in a process of its own, so that a crash is one of the failures.
void attack(const Source& source, std::uint64_t first, Figures& figures) {
  const auto outcome = harness::run_in_child(
      [&](harness::Heartbeat& heartbeat) {
        json report = {{"refused", 0}, {"failures", json::array()}};
        for (int i = 0; i < batch; ++i) {
          heartbeat.restart();
          heartbeat.step = i;
          std::mt19937_64 random(first + static_cast<std::uint64_t>(i));
          bool refused = false;
          const std::string found = defect(source, corrupt(source.text, random), refused);
          report["refused"] = report["refused"].get<int>() + (refused ? 1 : 0);
          if (!found.empty())
            report["failures"].push_back(source.name + ", seed " +
                                         std::to_string(first + static_cast<std::uint64_t>(i)) +
                                         ": " + found);
        }
        return report.dump(-1, ' ', false, json::error_handler_t::replace);
      },
      {.timeout = 2 * most_seconds, .memory = 4e9});
  figures.documents += batch;
  if (outcome.end != harness::ChildOutcome::End::returned) {
    const std::uint64_t seed =
        first + static_cast<std::uint64_t>(std::max<std::int64_t>(outcome.step, 0));
    figures.failures.push_back(
        source.name + ", seed " + std::to_string(seed) + ": " +
        (outcome.end == harness::ChildOutcome::End::timed_out ? "hangs" : ending(outcome)));
    return;
  }
  const json report = json::parse(outcome.text);
  figures.refused += report.at("refused").get<std::int64_t>();
  for (const json& failure : report.at("failures")) figures.failures.push_back(failure);
}

// One document again, in this process, for a debugger.
int again(const Source& source, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const std::string text = corrupt(source.text, random);
  std::ofstream("corrupted-document") << text;
  bool refused = false;
  const std::string found = defect(source, text, refused);
  std::cout << "written to corrupted-document: "
            << (!found.empty() ? found
                : refused      ? "refused"
                               : "taken")
            << '\n';
  return found.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  double seconds = 10;
  std::uint64_t seed = 1;
  bool once = false;
  std::vector<Source> sources;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--seconds" && i + 1 < argc) {
      seconds = std::atof(argv[++i]);
    } else if (word == "--seed" && i + 1 < argc) {
      seed = std::strtoull(argv[++i], nullptr, 10);
    } else if (word == "--once") {  // with the seed that a failure named
      once = true;
    } else {
      sources.push_back(source_of(word));
    }
  }
  if (sources.empty()) {
    std::cerr << "attack_documents: no good documents to corrupt\n";
    return 2;
  }
  if (once) return again(sources.front(), seed);
  Figures figures;
  const auto start = Clock::now();
  // Seeds of one run follow each other; runs are far apart.
  std::uint64_t next = seed << 32;
  while (std::chrono::duration<double>(Clock::now() - start).count() < seconds) {
    for (const Source& source : sources) {
      attack(source, next, figures);
      next += batch;
    }
  }
  std::filesystem::remove_all(scratch());
  json report = {{"documents", figures.documents},
                 {"refused", figures.refused},
                 {"failed", figures.failures.size()},
                 {"failures", json::array()}};
  for (std::size_t i = 0; i < std::min<std::size_t>(figures.failures.size(), 20); ++i)
    report["failures"].push_back(figures.failures[i].substr(0, 300));
  std::cout << report.dump(-1, ' ', false, json::error_handler_t::replace) << std::endl;
  return figures.failures.empty() ? 0 : 1;
}
