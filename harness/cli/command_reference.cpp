// bench reference: the trajectories that errors are measured against.
#include <iomanip>
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/paths.h"
#include "harness/base/text.h"
#include "harness/cli/commands.h"
#include "harness/cli/sweep_options.h"
#include "harness/judge/reference_file.h"
#include "harness/judge/reference_routes.h"
#include "harness/points/context.h"

namespace harness {
namespace {

using SceneOfReference = std::pair<std::string, SceneParameters>;

// How good it is, and where the scene's last vertex is.
void print_reference(std::ostream& out, const Reference& reference) {
  out << reference.scene << ": " << reference.method << "\n  against " << reference.second_method
      << "\n  observed order " << number_text(reference.observed_order, 3) << ", valid until "
      << reference.valid_until << " s";
  if (reference.energy_drift > 0)
    out << ", energy drift " << number_text(reference.energy_drift, 2) << " of weight times size";
  out << "\n  gap (over the scene's size, root mean square), what it is the largest of, end "
         "vertex:\n";
  for (std::size_t i = 0; i < reference.times.size(); ++i) {
    out << "  t = " << reference.times[i] << " s  " << number_text(reference.gap[i], 2);
    for (const auto& [name, part] : reference.gap_parts) {
      if (i < part.size()) out << "  " << name << ' ' << number_text(part[i], 2);
    }
    if (i < reference.positions.size()) {
      const auto end = reference.positions[i].col(reference.positions[i].cols() - 1);
      out << "  (" << std::setprecision(12) << end.x() << ", " << end.y() << ", " << end.z() << ')'
          << std::setprecision(6);
    }
    out << '\n';
  }
}

// Of one scene, at the sizes that were given.
std::vector<SceneOfReference> given_scenes(const SweepOptions& options) {
  if (options.scene.empty())
    throw UsageError("--n and --set go with --scene: of which scene is the reference to be?");
  const std::string scene = scene_of(options.scene, options.scene_words);
  const auto type = find_scene(scene);
  if (!type) throw UsageError("there is no scene '" + scene + "'; `bench list scenes` names them");
  SceneParameters given = parameters_of(options.scene_words);
  std::vector<SceneOfReference> scenes;
  if (options.n.empty()) scenes.emplace_back(scene, complete_parameters(*type, given));
  for (const double n : sizes_of(options.n)) {
    given[type->resolution] = n;
    scenes.emplace_back(scene, complete_parameters(*type, given));
  }
  return scenes;
}

// Those of a profile's sweeps.
std::vector<SceneOfReference> scenes_of_suite(const SweepOptions& options) {
  Suite suite = read_suite(suite_path(options));
  std::erase_if(suite.sweeps, [&](const SweepSpec& s) {
    return (!options.sweep.empty() && s.sweep != options.sweep) ||
           (!options.scene.empty() && s.scene != options.scene);
  });
  if (suite.sweeps.empty()) throw UsageError("no sweep of the suite has such a scene");
  ReferenceShelf nothing("");
  return without_reference(plan(suite, {}), nothing);
}

// Computes the references that are missing, or all of them. One that was stopped goes on after the
// runs that were done.
int make_references(const SweepOptions& options, bool again, double finest) {
  const bool given = !options.n.empty() || !parameters_of(options.scene_words).empty();
  auto missing = given ? given_scenes(options) : scenes_of_suite(options);
  const std::string folder = source_path("results/references");
  ReferenceShelf shelf(again ? "" : folder);
  std::erase_if(missing, [&shelf](const SceneOfReference& s) {
    return shelf.find(s.first, s.second) != nullptr;
  });
  const nlohmann::json build = machine_context().at("fingerprint");
  if (missing.empty()) std::cout << "nothing is missing (--again computes them anew)\n";
  for (const auto& [scene, parameters] : missing) {
    const std::string name = reference_name(scene, parameters);
    const std::string path = folder + "/" + name;
    check_writable(path);
    const auto tell = [&name](const std::string& line) {
      std::cerr << name << ": " << line << '\n';
    };
    ReferencePieces pieces(path, {{"schema", "inextensible-reference-pieces/1"},
                                  {"scene", scene},
                                  {"scene_parameters", parameters},
                                  {"finest", finest},
                                  {"build", build}});
    if (pieces.dropped()) tell("runs of another build or --finest are dropped");
    if (pieces.taken_up() > 0)
      tell("goes on after " + std::to_string(pieces.taken_up()) + " runs that are done");
    const Reference reference =
        compute_reference(scene, parameters, finest, tell,
                          [&pieces](const auto& run, const auto& compute) -> const RouteRun& {
                            return pieces.run(run, compute);
                          });
    write_atomically(path, to_json(reference).dump() + "\n");
    pieces.remove();
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
  add_scene_selection(command, given->options);
  command.flag("--again", given->again, "those that are there already, too");
  command.option("--finest", given->finest, "smallest step of step halving, s", "S").positive();
  command.does([given] { return make_references(given->options, given->again, given->finest); });
}

}  // namespace harness
