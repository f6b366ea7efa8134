// bench claims: the paper's claims, decided from result files.
#include <algorithm>
#include <iostream>
#include <sstream>
#include <string_view>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/claims/claims.h"
#include "harness/claims/judging.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/verbs.h"
#include "harness/points/result_file.h"

namespace harness {

Verb claims_verb() {
  return {"claims", "decide the paper's claims from result files",
          [](const Command& command) -> Action {
            struct Given {
              std::vector<std::string> files;
              std::string markdown;
            };
            const auto given = std::make_shared<Given>();
            command.option("results", given->files, "result files", "RESULT.json").required();
            command.option("--markdown", given->markdown, "also write the table in Markdown",
                           "FILE");
            return [given] {
              if (!given->markdown.empty()) check_writable(given->markdown);
              std::vector<nlohmann::json> results;
              results.reserve(given->files.size());
              for (const std::string& file : given->files) {
                nlohmann::json document = read_result_or_answers(file);
                if (!is_answers(document))
                  results.push_back(std::move(document));  // no claim is about those
              }
              if (results.empty())
                throw UsageError("claims are about sweeps; results/*.json has some");
              const std::vector<ClaimVerdict> verdicts = judge_claims(results);
              if (std::all_of(verdicts.begin(), verdicts.end(), [](const ClaimVerdict& claim) {
                    return claim.verdict == std::string_view(claims::not_measured);
                  }))
                throw UsageError("nothing in '" + given->files.front() +
                                 "' is what a claim is about; results/*.json are");
              if (!given->markdown.empty()) {
                std::ostringstream table;
                print_claims_markdown(table, verdicts);
                write_atomically(given->markdown, table.str());
              }
              print_claims(std::cout, verdicts);
              return success;
            };
          }};
}

}  // namespace harness
