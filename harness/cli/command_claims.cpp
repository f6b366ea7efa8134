// bench claims: the paper's claims, decided from result files.
#include <algorithm>
#include <iostream>
#include <string_view>

#include "harness/base/errors.h"
#include "harness/claims/claims.h"
#include "harness/claims/verdicts.h"
#include "harness/cli/commands.h"
#include "harness/points/result_file.h"

namespace harness {

void add_claims_command(const Command& program) {
  struct Given {
    std::vector<std::string> files;
    bool markdown = false;
  };
  const auto given = std::make_shared<Given>();
  const Command command =
      program.subcommand("claims", "the paper's claims C1 to C16, decided from result files");
  command.option("results", given->files, "result files", "RESULT.json").required();
  command.flag("--markdown", given->markdown, "a table for the README");
  command.does([given] {
    std::vector<nlohmann::json> results;
    results.reserve(given->files.size());
    for (const std::string& file : given->files) {
      nlohmann::json document = read_result_or_answers(file);
      if (!is_answers(document)) results.push_back(std::move(document));  // no claim is about those
    }
    if (results.empty()) throw UsageError("claims are about sweeps; results/*.json has some");
    const std::vector<ClaimVerdict> verdicts = judge_claims(results);
    if (std::all_of(verdicts.begin(), verdicts.end(), [](const ClaimVerdict& claim) {
          return claim.verdict == std::string_view(claims::not_measured);
        }))
      throw UsageError("nothing in '" + given->files.front() +
                       "' is what a claim is about; results/*.json are");
    (given->markdown ? print_claims_markdown : print_claims)(std::cout, verdicts);
    return success;
  });
}

}  // namespace harness
