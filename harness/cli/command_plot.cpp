// bench plot: the figures of a result file, drawn again.
#include "harness/cli/commands.h"

namespace harness {

void add_plot_command(CLI::App& app, Chosen& chosen) {
  struct Given {
    std::string file, out;
  };
  const auto given = std::make_shared<Given>();
  CLI::App* command = app.add_subcommand("plot", "draw the figures of a result file");
  command->add_option("result", given->file, "result file")->required()->type_name("RESULT.json");
  command->add_option("--out", given->out, "folder for the figures; default: beside the result")
      ->type_name("DIR");
  command->callback([given, &chosen] {
    chosen = [given] {
      std::vector<std::string> arguments{given->file};
      if (!given->out.empty()) arguments.insert(arguments.end(), {"--out", given->out});
      return draw(arguments);
    };
  });
}

}  // namespace harness
