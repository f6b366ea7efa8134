// bench reference: the trajectories that errors are measured against.
#include <filesystem>
#include <iomanip>

#include "harness/base/json.h"
#include "harness/cli/command.h"
#include "harness/judge/reference_routes.h"
#include "harness/points/context.h"

namespace harness {
namespace {

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

// The runs of a reference, kept beside its file.
RouteRuns runs_beside(const std::string& path, const std::string& scene,
                      const SceneParameters& parameters, double finest) {
  const std::string name = std::filesystem::path(path).filename().string();
  return RouteRuns([name](const std::string& line) { std::cerr << name << ": " << line << '\n'; },
                   path,
                   {{"schema", "inextensible-reference-pieces/1"},
                    {"scene", scene},
                    {"scene_parameters", parameters},
                    {"finest", finest},
                    {"build", machine_context().at("fingerprint")}});
}

// What was stopped goes on after the runs that were done.
void make_reference(const std::string& path, const std::string& scene,
                    const SceneParameters& parameters, double finest) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  check_writable(path);
  RouteRuns runs = runs_beside(path, scene, parameters, finest);
  const Reference reference = compute_reference(scene, parameters, finest, runs);
  write_atomically(path, to_json(reference).dump() + "\n");
  runs.remove();
  print_reference(std::cout, reference);
  std::cout << path << std::endl;
}

struct ReferenceVerb : SelectionOptions {
  bool again = false;
  double finest = 0;

  void declare(const Command& command) {
    declare_scenes(command, command);
    command.flag("--again", again, "also what exists already");
    command.option("--finest", finest, "smallest step of step halving, s", "S", Bounds::positive());
  }

  // One scene at the sizes that were given.
  std::vector<SceneOfReference> given_scenes() const {
    if (scene.empty())
      throw UsageError("--n and --set go with --scene: of which scene is the reference to be?");
    if (n.empty()) return {{name(), complete_parameters()}};
    std::vector<SceneOfReference> scenes;
    SceneOptions one = *this;
    for (const double size : numbers_of("--n", n, Bounds::whole_number(1))) {
      one.n = number_text(size, 10);
      scenes.emplace_back(name(), one.complete_parameters());
    }
    return scenes;
  }

  // Those of a profile's sweeps.
  std::vector<SceneOfReference> scenes_of_suite() const {
    Suite suite = read_suite(suite_path(*this));
    std::erase_if(suite.sweeps, [this](const SweepSpec& s) {
      return (!sweep.empty() && s.sweep != sweep) || (!scene.empty() && s.scene != scene);
    });
    if (suite.sweeps.empty()) throw UsageError("no sweep of the suite has such a scene");
    ReferenceFolder nothing("");
    std::vector<SceneOfReference> scenes;
    for (const auto& [file, missing] : without_reference(plan(suite, {}), nothing))
      scenes.push_back(missing);
    return scenes;
  }

  // Makes what is missing, or all of it.
  int run() const {
    const bool one_scene = !n.empty() || !set.empty() || scene.starts_with("mesh:");  // of no suite
    const auto references = ReferenceFolder::usual();
    bool nothing = true;
    for (const auto& [name, parameters] : one_scene ? given_scenes() : scenes_of_suite()) {
      if (references->find(name, parameters) && !again) continue;
      make_reference(reference_path(name, parameters), name, parameters, finest);
      nothing = false;
    }
    if (nothing) std::cout << "nothing is missing (--again computes again)\n";
    return success;
  }
};

}  // namespace

Action reference_verb(const Command& command) { return verb<ReferenceVerb>(command); }

}  // namespace harness
