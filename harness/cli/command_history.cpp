// bench history: how each solver's times have changed over the results of a folder.
#include "harness/cli/commands.h"

namespace harness {

void add_history_command(const Command& program) {
  struct Given {
    std::string folder, out;
  };
  const auto given = std::make_shared<Given>();
  const Command command = program.subcommand(
      "history", "draw the times of best points over the result files of a folder, by their dates");
  command.option("folder", given->folder, "where the result files are", "DIR").required();
  command.option("--out", given->out,
                 "the figure, .svg or .png; default: history.svg in the folder", "FIGURE");
  command.does([given] {
    std::vector<std::string> arguments{given->folder};
    if (!given->out.empty()) arguments.insert(arguments.end(), {"--out", given->out});
    return draw(arguments, "history.py");
  });
}

}  // namespace harness
