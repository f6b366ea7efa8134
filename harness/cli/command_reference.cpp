// bench reference: the trajectories and ensembles that errors are measured against.
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

void print_ensemble(std::ostream& out, const Ensemble& ensemble) {
  for (const std::string& method : ensemble.methods) out << "  ensemble: " << method << '\n';
  if (!ensemble.known()) {
    if (!ensemble.unknown_because.empty()) out << "  " << ensemble.unknown_because << '\n';
    return;
  }
  out << "  at its end, mean and standard deviation:";
  for (const auto& [name, member] : shape_statistic_infos)
    out << "  " << name << ' ' << number_text(ensemble.mean.back().*member, 3) << ' '
        << number_text(ensemble.deviation.back().*member, 2);
  out << '\n';
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

// By both routes, and of cloth an ensemble; of one that is stored the ensemble alone, and its path
// stays as it is. What was stopped goes on after the runs that were done.
void make_reference(const std::string& path, const std::string& scene,
                    const SceneParameters& parameters, double finest, const Reference* stored) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  check_writable(path);
  RouteRuns runs = runs_beside(path, scene, parameters, finest);
  Reference reference = stored ? *stored : compute_reference(scene, parameters, finest, runs);
  const Scene built = find_scene(scene)->build(parameters);
  if (is_cloth(built) && reference.valid_until < reference.duration())
    reference.ensemble = compute_ensemble(built, reference.times, {}, runs);
  const nlohmann::json document =
      stored ? with_ensemble(parse_document(read_file(path, "reference"), path), reference.ensemble)
             : to_json(reference);
  write_atomically(path, document.dump() + "\n");
  runs.remove();
  if (stored) {
    std::cout << reference.scene << ":\n";
  } else {
    print_reference(std::cout, reference);
  }
  print_ensemble(std::cout, reference.ensemble);
  std::cout << path << std::endl;
}

bool wants_ensemble(const Reference& reference, bool again) {
  const Ensemble& ensemble = reference.ensemble;
  const bool there = ensemble.known() || !ensemble.unknown_because.empty();
  return !reference.exact && (again || !there) && reference.valid_until < reference.duration() &&
         is_cloth(find_scene(reference.scene)->build(reference.parameters));
}

struct ReferenceVerb : SelectionOptions {
  bool again = false, only_ensemble = false;
  double finest = 0;

  void declare(const Command& command) {
    declare_scenes(command, command);
    command.flag("--again", again, "also what exists already");
    command.flag("--ensemble", only_ensemble,
                 "only ensembles of references that exist; their paths stay as they are");
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

  // Makes what is missing, or all of it: references, and ensembles of those that are there.
  int run() const {
    if (only_ensemble && finest > 0)
      throw UsageError("--finest does not go with --ensemble, whose runs have a step of their own");
    const bool one_scene = !n.empty() || !set.empty() || scene.starts_with("mesh:");  // of no suite
    const auto references = ReferenceFolder::usual();
    bool nothing = true;
    for (const auto& [name, parameters] : one_scene ? given_scenes() : scenes_of_suite()) {
      const std::string path = reference_path(name, parameters);
      const auto stored = references->find(name, parameters);
      if (!only_ensemble && (!stored || again)) {
        make_reference(path, name, parameters, finest, nullptr);
      } else if (stored && wants_ensemble(*stored, again)) {
        make_reference(path, name, parameters, 0, stored.get());
      } else if (!stored) {
        std::cerr << path << " is not there: bench reference makes it\n";
      } else {
        continue;
      }
      nothing = false;
    }
    if (nothing) std::cout << "nothing is missing (--again computes again)\n";
    return success;
  }
};

}  // namespace

Action reference_verb(const Command& command) { return verb<ReferenceVerb>(command); }

}  // namespace harness
