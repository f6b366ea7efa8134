// bench plot: the figures of a result file, drawn again.
#include "harness/cli/commands.h"

namespace harness {

void add_plot_command(const Command& program) {
  struct Given {
    std::string file, out;
  };
  const auto given = std::make_shared<Given>();
  const Command command = program.subcommand("plot", "draw the figures of a result file");
  command.option("result", given->file, "result file", "RESULT.json").required();
  command.option("--out", given->out, "folder for the figures; default: beside the result", "DIR");
  command.does([given] {
    std::vector<std::string> arguments;
    if (!given->out.empty()) arguments = {"--out", given->out};
    return draw_result(given->file, arguments);
  });
}

}  // namespace harness
