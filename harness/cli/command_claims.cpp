// bench claims: the paper's claims, decided from result files.
#include <iostream>

#include "harness/claims/claims.h"
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
    for (const std::string& file : given->files) results.push_back(read_result(file));
    (given->markdown ? print_claims_markdown : print_claims)(std::cout, judge_claims(results));
    return success;
  });
}

}  // namespace harness
