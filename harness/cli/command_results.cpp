// bench results: tables of what result files say, as a page of Markdown.
#include <iostream>
#include <sstream>

#include "harness/base/files.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/verbs.h"
#include "harness/points/result_file.h"
#include "harness/tables/results_page.h"

namespace harness {
namespace {

struct ResultsOptions {
  std::vector<std::string> results, growth, answers;
  std::string out;
};

std::vector<NamedResult> read(const std::vector<std::string>& files) {
  std::vector<NamedResult> results;
  results.reserve(files.size());
  for (const std::string& file : files) results.push_back({file, read_result(file)});
  return results;
}

// The page begins with the command that makes it again.
std::string page(const ResultsOptions& given) {
  std::ostringstream out;
  out << "# Results\n\nThis page is generated; do not edit it. The command, which gives every file "
         "that the numbers come from:\n\n```sh\n./bench results";
  for (const std::string& file : given.results) out << ' ' << file;
  if (!given.growth.empty()) out << " --growth";
  for (const std::string& file : given.growth) out << ' ' << file;
  if (!given.answers.empty()) out << " --answers";
  for (const std::string& file : given.answers) out << ' ' << file;
  if (!given.out.empty()) out << " --out " << given.out;
  out << "\n```\n\nTimes are the least of several samples. [measuring.md](measuring.md) says what "
         "they mean, and how far they can be trusted. Ratios have their 95 % interval, "
         "`3.5 (3.3-3.8)`; `3.5 (?)`: it is not known, for too few runs and no A/A pair. "
         "`bench show RESULT.json --all` has every contestant of a file, `bench report` every "
         "run.\n\n";
  std::vector<NamedResult> results, answers;
  for (const std::string& file : given.results) {
    NamedResult result{file, read_result_or_answers(file)};
    (is_answers(result.document) ? answers : results).push_back(std::move(result));
  }
  for (const std::string& file : given.answers) answers.push_back({file, read_answers(file)});
  print_results_page(out, results, read(given.growth), answers);
  return out.str();
}

}  // namespace

Verb results_verb() {
  return {
      "results", "write tables of result files in Markdown (docs/results.md)",
      [](const Command& command) -> Action {
        const auto given = std::make_shared<ResultsOptions>();
        command
            .option("results", given->results,
                    "result files; of points that several have, the first one's count for claims",
                    "RESULT.json ...")
            .required();
        command.option("--growth", given->growth, "result files for the tables of growth alone",
                       "RESULT.json ...");
        command.option("--answers", given->answers, "results of bench answers", "ANSWERS.json ...");
        command.option("--out", given->out, "the page; default: standard output", "FILE");
        return [given] {
          if (given->out.empty()) {
            std::cout << page(*given);
          } else {
            check_writable(given->out);
            write_atomically(given->out, page(*given));
          }
          return success;
        };
      }};
}

}  // namespace harness
