// bench history: how each solver's times have changed over the results of a folder.
#include "harness/cli/commands.h"

namespace harness {

void add_history_command(CLI::App& app, Chosen& chosen) {
  struct Given {
    std::string folder, out;
  };
  const auto given = std::make_shared<Given>();
  CLI::App* command = app.add_subcommand(
      "history", "draw the times of best points over the result files of a folder, by their dates");
  command->add_option("folder", given->folder, "where the result files are")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--out", given->out,
                   "the figure, .svg or .png; default: history.svg in the folder")
      ->type_name("FIGURE");
  command->callback([given, &chosen] {
    chosen = [given] {
      std::vector<std::string> arguments{given->folder};
      if (!given->out.empty()) arguments.insert(arguments.end(), {"--out", given->out});
      return draw(arguments, "history.py");
    };
  });
}

}  // namespace harness
