// bench: the command line.
#include "harness/base/child_process.h"
#include "harness/base/standard_streams.h"
#include "harness/cli/command.h"
#include "harness/compare/comparison.h"
#include "harness/points/context.h"
#include "harness/points/plugins.h"

namespace harness {
namespace {

constexpr const char* description =
    "bench: benchmark of solvers for inextensible cloth and chains: time at each strain limit, "
    "error and size.\n"
    "\n"
    "  bench --sweep strain                     Figures 4a and 5a of Goldenthal et al. 2007\n"
    "  bench --sweep strain --profile quick     a first look\n"
    "  bench --sweep resolution --scene chain   Figure 4b\n"
    "  bench --sweep step --scene chain         time against error\n"
    "  bench --sweep stability                  hard cases: which solver fails where\n"
    "  bench show RESULT.json                   the result in two sentences, and its table\n"
    "  bench help VERB                          the options of a verb (SUBCOMMANDS, below)\n";

std::string version_text() {
  const nlohmann::json build = machine_context().at("build");
  const std::string commit = build.at("git");
  return std::string("bench ") + version() +
         (commit.empty() ? "" : ", commit " + commit.substr(0, 12)) +
         (build.at("dirty").get<bool>() ? " with changes" : "") + ", " +
         build.at("type").get<std::string>() + " by " + build.at("compiler").get<std::string>() +
         " with " + build.at("flags").get<std::string>();
}

void load(const Words& plugins) {
  {
    const OutputToError no_output;
    for (const std::string& file : plugins) load_plugin(file);
  }
  for (const Plugin& plugin : loaded_plugins()) {
    if (!plugin.optimized)
      std::cerr << "bench: plug-in '" << plugin.file
                << "' was compiled without optimization: its times are meaningless\n";
  }
}

// What goes wrong is said in a line on stderr, and is an exit code.
int guarded(const std::function<int()>& work) {
  try {
    const int code = work();
    check_standard_output();
    send_output_to_error();  // what plug-ins print as they are unloaded
    return code;
  } catch (const UsageError& error) {
    std::cerr << "bench: " << error.what() << '\n';
    return usage_error;
  } catch (const nlohmann::json::exception& error) {
    // Schemas are checked where files are read; what a schema leaves open is reported here.
    std::cerr << "bench: a value in a file has the wrong type: " << error.what() << '\n';
    return usage_error;
  } catch (const NotComparable& reason) {
    std::cerr << "bench: " << reason.what() << '\n';
    return not_comparable;
  } catch (const Interrupted&) {
    std::cerr << "bench: interrupted\n";
    return interrupted_exit;
  } catch (const FileError& error) {
    std::cerr << "bench: " << error.what() << '\n';
    return internal_error;
  } catch (const std::exception& error) {
    std::cerr << "bench: internal error: " << error.what() << '\n';
    return internal_error;
  }
}

int run(int argc, char** argv) {
  CommandLine line(description, verbs(), version_text);
  if (const std::optional<int> done = line.read(argc, argv)) return *done;
  catch_interrupts();
  const auto act = [&line] {
    return guarded([&line] {
      load(line.plugins());
      return line.run();
    });
  };
  return line.has_children() ? act() : supervised(act);
}

}  // namespace
}  // namespace harness

int main(int argc, char** argv) {
  harness::open_standard_streams();
  harness::use_one_thread();
  return harness::guarded([&] { return harness::run(argc, argv); });
}
