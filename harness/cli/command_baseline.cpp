// bench baseline: a result for the next comparisons.
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/json_text.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/verbs.h"
#include "harness/compare/comparison.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

int make_baseline(const std::vector<std::string>& files, const std::string& out) {
  std::vector<nlohmann::json> results;
  results.reserve(files.size());
  for (const std::string& file : files) results.push_back(read_result(file));
  const ComparedResult checked = read_compared(files);  // all that a comparison will ask for
  if (checked.baseline) throw UsageError("a baseline is made from result files");
  if (!checked.complete)
    throw UsageError("'" + checked.path + "' is of an interrupted run: no baseline");
  check_writable(out);
  write_atomically(out, document_text(baseline_document(results)));
  std::cout << out << ": " << checked.points.size() << " points" << std::endl;
  return success;
}

}  // namespace

Verb baseline_verb() {
  return {"baseline", "reduce results to a file without times, to compare with later",
          [](const Command& command) -> Action {
            struct Given {
              std::vector<std::string> files;
              std::string out;
            };
            const auto given = std::make_shared<Given>();
            command.option("results", given->files, "result files", "RESULT.json").required();
            command.option("--out", given->out, "the baseline", "FILE").required();
            return [given] { return make_baseline(given->files, given->out); };
          }};
}

}  // namespace harness
