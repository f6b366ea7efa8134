// bench: the command line.
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/interrupt.h"
#include "harness/base/standard_streams.h"
#include "harness/base/text.h"
#include "harness/cli/commands.h"
#include "harness/points/context.h"
#include "harness/points/plugins.h"

namespace harness {
namespace {

// A result is no place for a machine's folders.
std::vector<std::string> command_words(int argc, char** argv) {
  std::vector<std::string> words{"bench"};
  for (int i = 1; i < argc; ++i) {
    const std::filesystem::path argument(argv[i]);
    words.push_back(argument.is_absolute() ? argument.filename().string() : argument.string());
  }
  return words;
}

std::string version_text() {
  const nlohmann::json build = machine_context().at("build");
  const std::string commit = build.at("git");
  return std::string("bench ") + version() +
         (commit.empty() ? "" : ", commit " + commit.substr(0, 12)) +
         (build.at("dirty").get<bool>() ? " with changes" : "") + ", " +
         build.at("type").get<std::string>() + " by " + build.at("compiler").get<std::string>() +
         " with " + build.at("flags").get<std::string>();
}

int run(int argc, char** argv) {
  CommandLine line(
      "bench: which solver keeps cloth and chains from stretching fastest, at which strain, at "
      "which size.\n"
      "\n"
      "  bench --sweep strain                     Figures 4a and 5a of Goldenthal et al. 2007, in "
      "six minutes\n"
      "  bench --sweep resolution --scene chain   Figure 4b\n"
      "  bench --sweep strain --profile quick     a first look, in under a minute\n"
      "  bench show RESULT.json                   the answer in two sentences, and its table\n"
      "  bench plot RESULT.json                   draws the figures of a result file again\n"
      "  bench report RESULT.json ... -o it.html  one page that tells what results found\n"
      "  bench --sweep step --scene chain         time against error: who at which accuracy\n"
      "  bench --sweep stability                  hard cases: which solver breaks where\n"
      "  bench answers                            figures that theory knows, by each solver\n"
      "  bench film --out drape.webp              what it looks like\n"
      "  bench reference                          the trajectories that errors are measured "
      "against\n"
      "  bench claims RESULT.json ...             the paper's claims, decided by measurements\n"
      "  bench emit slurm --shards 8 ... > job.sh  the same on many machines, under Slurm or GNU "
      "parallel\n"
      "  bench check --solver NAME                whether a solver keeps what every solver must\n"
      "  bench compare BASE.json NEW.json         what has become slower or fails now, for CI\n"
      "  bench tune                               searches each solver's settings, on scenes of "
      "their own\n"
      "  bench ab OLD_BINARY NEW_BINARY           two builds against each other, in interleaved "
      "runs\n"
      "  bench choose --scene mesh:IT.obj ...     which solver to take for a scene of yours\n"
      "  bench list                               solvers, scenes and suites with their "
      "settings\n",
      version_text);
  const Command program = line.program();
  const std::vector<std::string> command = command_words(argc, argv);
  add_sweep_command(program, command);
  add_tune_command(program);
  add_show_command(program);
  add_plot_command(program);
  add_report_command(program);
  add_reference_command(program);
  add_claims_command(program);
  add_results_command(program);
  add_answers_command(program, command);
  add_film_command(program);
  add_emit_command(program);
  add_compare_command(program);
  add_baseline_command(program);
  add_point_command(program);
  add_ab_command(program);
  add_list_command(program);
  add_merge_command(program);
  add_check_command(program);
  add_choose_command(program);
  const Command manual = program.subcommand("man", "print the manual page: bench man | man -l -");
  manual.does([&line] {
    std::cout << line.manual();
    return success;
  });
  const Command completion =
      program.subcommand("completion", "print completion for Bash: source <(bench completion)");
  completion.does([&line] {
    std::cout << line.bash_completion();
    return success;
  });
  std::vector<std::string> plugins;
  line.add_everywhere(
      "--plugin", plugins,
      "load solvers of your own from a shared library (solvers/plugin.h); repeatable", "FILE");
  if (const std::optional<int> done = line.read(argc, argv)) return *done;
  for (const std::string& file : plugins) load_plugin(file);
  for (const Plugin& plugin : loaded_plugins()) {
    if (!plugin.optimized)
      std::cerr << "bench: plug-in '" << plugin.file
                << "' was compiled without optimization: its times say nothing\n";
  }
  return line.run();
}

}  // namespace
}  // namespace harness

int main(int argc, char** argv) {
  harness::open_standard_streams();
  harness::use_one_thread();
  try {
    const int code = harness::run(argc, argv);
    harness::check_standard_output();
    return code;
  } catch (const harness::UsageError& error) {
    std::cerr << "bench: " << error.what() << '\n';
    return harness::usage_error;
  } catch (const nlohmann::json::exception& error) {
    // Schemas are checked where files are read; what one leaves open is the file's fault all the
    // same.
    std::cerr << "bench: a file holds something of the wrong kind: " << error.what() << '\n';
    return harness::usage_error;
  } catch (const harness::Interrupted&) {
    return harness::interrupted_exit;
  } catch (const harness::FileError& error) {
    std::cerr << "bench: " << error.what() << '\n';
    return harness::internal_error;
  } catch (const std::exception& error) {
    std::cerr << "bench: internal error: " << error.what() << '\n';
    return harness::internal_error;
  }
}
