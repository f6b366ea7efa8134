// bench reference: the trajectories that errors are measured against.
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/paths.h"
#include "harness/cli/commands.h"
#include "harness/cli/sweep_options.h"
#include "harness/judge/reference_file.h"
#include "harness/judge/reference_routes.h"
#include "harness/run/report.h"

namespace harness {
namespace {

// Computes the references of a profile's sweeps that are missing, or all of them.
int make_references(const SweepOptions& options, bool again, double finest) {
  Suite suite = read_suite(suite_path(options));
  std::erase_if(suite.sweeps, [&](const SweepSpec& s) {
    return (!options.sweep.empty() && s.sweep != options.sweep) ||
           (!options.scene.empty() && s.scene != options.scene);
  });
  if (suite.sweeps.empty()) throw UsageError("no sweep of the suite has such a scene");
  const auto searches = plan(suite, {});
  const std::string folder = source_path("results/references");
  ReferenceShelf shelf(again ? "" : folder);
  const auto missing = without_reference(searches, shelf);
  if (missing.empty()) std::cout << "nothing is missing (--again computes them anew)\n";
  for (const auto& [scene, parameters] : missing) {
    const std::string name = reference_name(scene, parameters);
    const std::string path = folder + "/" + name;
    check_writable(path);
    const Reference reference = compute_reference(
        scene, parameters, finest,
        [&name](const std::string& line) { std::cerr << name << ": " << line << '\n'; });
    write_atomically(path, to_json(reference).dump() + "\n");
    print_reference(std::cout, reference);
    std::cout << path << std::endl;
  }
  return success;
}

}  // namespace

void add_reference_command(const Command& program) {
  struct Given {
    SweepOptions options;
    bool again = false;
    double finest = 0;
  };
  const auto given = std::make_shared<Given>();
  const Command command = program.subcommand(
      "reference",
      "compute the reference trajectories that a profile's sweeps are measured against");
  add_selection(command, given->options);
  command.flag("--again", given->again, "those that are there already, too");
  command.option("--finest", given->finest, "smallest step of step halving, s", "S").positive();
  command.does([given] { return make_references(given->options, given->again, given->finest); });
}

}  // namespace harness
