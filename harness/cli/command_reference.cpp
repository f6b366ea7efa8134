// bench reference: the trajectories that errors are measured against.
#include "harness/cli/command.h"
#include "harness/judge/reference_routes.h"
#include "harness/points/context.h"

namespace harness {
namespace {

// Finished runs are stored beside it, so that an interrupted computation resumes after them.
void make_reference(const std::string& scene, const SceneParameters& parameters, double finest) {
  const std::filesystem::path path(reference_path(scene, parameters));
  std::filesystem::create_directories(path.parent_path());
  check_writable(path);
  RouteRuns runs([name = path.filename().string()](
                     const std::string& line) { std::cerr << name << ": " << line << '\n'; },
                 path,
                 {{"schema", "inextensible-reference-pieces/1"},
                  {"scene", scene},
                  {"scene_parameters", parameters},
                  {"finest", finest},
                  {"build", machine_context().at("fingerprint")}});
  const Reference reference = compute_reference(scene, parameters, finest, runs);
  write_atomically(path, to_json(reference).dump() + "\n");
  runs.remove();
  std::cout << scene << ": " << reference_text(reference) << '\n' << path.string() << std::endl;
}

struct ReferenceVerb : SweepOptions {
  bool again = false;

  void declare(const Command& command) {
    least_n = 1;  // a mesh as it is
    declare_scenes(command, command);
    command.flag("--again", again, "also compute references that exist already");
    command.option("--finest", finest, "smallest step of step halving, s", "S", Bounds::positive());
  }

  std::vector<SceneOfReference> given_scenes() const {
    if (scene.empty()) throw UsageError("--n and --set go with --scene");
    if (n.empty()) return {{name(), complete_parameters()}};
    std::vector<SceneOfReference> scenes;
    SceneOptions one = *this;
    for (const double size : n) {
      one.n = {size};
      scenes.emplace_back(name(), one.complete_parameters());
    }
    return scenes;
  }

  std::vector<SceneOfReference> scenes_of_suite() const {
    Suite suite = read_suite(suite_path(*this));
    std::erase_if(suite.sweeps, [this](const SweepSpec& s) {
      return (!sweep.empty() && s.sweep != sweep) || (!scene.empty() && s.scene != scene);
    });
    if (suite.sweeps.empty()) throw UsageError("no sweep of the suite has such a scene");
    ReferenceFolder nothing(std::vector<std::string>{});
    std::vector<SceneOfReference> scenes;
    for (const auto& [file, missing] : without_reference(plan(suite, {}), nothing))
      scenes.push_back(missing);
    return scenes;
  }

  int run() const {
    const bool one_scene = !n.empty() || !set.empty() || scene.starts_with("mesh:");  // of no suite
    const auto references = ReferenceFolder::usual();
    bool nothing = true;
    for (const auto& [name, parameters] : one_scene ? given_scenes() : scenes_of_suite()) {
      if (references->find(name, parameters) && !again) continue;
      make_reference(name, parameters, finest);
      nothing = false;
    }
    if (nothing) std::cout << "nothing is missing (--again computes again)\n";
    return success;
  }
};

}  // namespace

Action reference_verb(const Command& command) { return verb<ReferenceVerb>(command); }

}  // namespace harness
