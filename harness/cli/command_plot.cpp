// bench plot: the figures of a result file, drawn again; of several, which are pieces of one sweep,
// drawn as one.
#include <filesystem>

#include "harness/base/errors.h"
#include "harness/cli/figures.h"
#include "harness/cli/verbs.h"

namespace harness {

Verb plot_verb() {
  return {"plot", "draw the figures of a result file again; of several pieces of one sweep as one",
          [](const Command& command) -> Action {
            struct Given {
              std::vector<std::string> files;
              std::string out, name;
            };
            const auto given = std::make_shared<Given>();
            command
                .option("results", given->files,
                        "result file; several: pieces of one sweep, drawn as one, with --name",
                        "RESULT.json ...")
                .required();
            command.option("--out", given->out,
                           "folder for the figures; default: beside the result", "DIR");
            command.option("--name", given->name,
                           "of several files: what the pictures' names begin with", "NAME");
            return [given] {
              const bool several = given->files.size() > 1;
              if (several == given->name.empty())
                throw UsageError(
                    several ? "several result files are drawn as one: give it a --name"
                            : "--name is for several result files; pictures of one have its name");
              std::string out = given->out;
              if (several && out.empty())
                out = std::filesystem::path(given->files.front()).parent_path().string();
              if (several) return draw_pieces(given->files, given->name, out);
              return draw_result(given->files.front(), out);
            };
          }};
}

}  // namespace harness
