// bench merge: joins result files, of shards for instance.
#include <filesystem>
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/verbs.h"
#include "harness/points/result_file.h"
#include "harness/points/schema.h"
#include "harness/run/merge.h"
#include "harness/stability/merge_stability.h"

namespace harness {

Verb merge_verb() {
  return {
      "merge", "join the result files of a sweep's parts", [](const Command& command) -> Action {
        struct Given {
          std::vector<std::string> files;
          std::string out;
          MergeOptions options;
        };
        const auto given = std::make_shared<Given>();
        command.option("results", given->files, "result files", "RESULT.json").required();
        command.option("--out", given->out, "the joined result file", "FILE").required();
        command.flag("--allow-mixed", given->options.mixed, "even if machines or builds differ");
        command.flag("--partial", given->options.partial,
                     "even if shards are missing; the result says that it is not complete");
        return [given] {
          std::vector<NamedResult> results;
          for (const std::string& file : given->files) {
            results.push_back({std::filesystem::path(file).filename().string(), read_result(file)});
            if (results.back().document.at("schema") != results.front().document.at("schema"))
              throw UsageError("'" + given->files.front() + "' and '" + file +
                               "' are of different kinds of sweeps");
          }
          check_writable(given->out);
          // One file is whole as it is; written again, it is laid out as files are written now.
          const nlohmann::json& first = results.front().document;
          nlohmann::json whole = first;
          if (results.size() > 1 || is_shard(first))
            whole = first.contains("matrix") ? merge_stability(results, given->options)
                                             : merge(results, given->options);
          if (!whole.contains("legend")) whole["legend"] = legend();
          write_atomically(given->out, result_text(whole));
          if (whole.contains("points"))
            std::cout << whole.at("points").size() << " points of " << results.size() << " files\n";
          std::cout << given->out << '\n';
          return success;
        };
      }};
}

}  // namespace harness
