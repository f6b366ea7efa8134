// bench reference: the trajectories and ensembles that errors are measured against.
#include <filesystem>
#include <iomanip>
#include <iostream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/base/paths.h"
#include "harness/base/text.h"
#include "harness/cli/exit_codes.h"
#include "harness/cli/sweep_options.h"
#include "harness/cli/verbs.h"
#include "harness/judge/ensemble_runs.h"
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

// A reference's file, and where what belongs to it is kept while it is made.
class PendingReference {
 public:
  PendingReference(const std::string& path, const std::string& scene,
                   const SceneParameters& parameters, double finest)
      : name_(std::filesystem::path(path).filename().string()),
        pieces_(path, {{"schema", "inextensible-reference-pieces/1"},
                       {"scene", scene},
                       {"scene_parameters", parameters},
                       {"finest", finest},
                       {"build", machine_context().at("fingerprint")}}) {
    for (const std::string& line : pieces_.news()) tell(line);
  }

  void tell(const std::string& line) const { std::cerr << name_ << ": " << line << '\n'; }
  Tell teller() const {
    return [this](const std::string& line) { tell(line); };
  }
  KeepRun keeper() {
    return [this](const auto& run, const auto& compute) -> const RouteRun& {
      return pieces_.run(run, compute);
    };
  }
  void done() { pieces_.remove(); }

 private:
  std::string name_;
  ReferencePieces pieces_;
};

Ensemble ensemble_for(const Scene& scene, const std::vector<double>& times,
                      PendingReference& making) {
  return is_cloth(scene) ? compute_ensemble(scene, times, {}, making.teller(), making.keeper())
                         : Ensemble();
}

// By both routes, and of cloth an ensemble. One that was stopped goes on after the runs that were
// done.
void make_reference(const std::string& path, const std::string& scene,
                    const SceneParameters& parameters, double finest) {
  check_writable(path);
  PendingReference making(path, scene, parameters, finest);
  Reference reference =
      compute_reference(scene, parameters, finest, making.teller(), making.keeper());
  reference.ensemble = ensemble_for(find_scene(scene)->build(parameters), reference.times, making);
  write_atomically(path, to_json(reference).dump() + "\n");
  making.done();
  print_reference(std::cout, reference);
  print_ensemble(std::cout, reference.ensemble);
  std::cout << path << std::endl;
}

// Makes the ensemble of a reference that is there. Its path stays as it is.
void add_ensemble(const std::string& path, const Reference& reference) {
  check_writable(path);
  PendingReference making(path, reference.scene, reference.parameters, 0);
  const Scene scene = find_scene(reference.scene)->build(reference.parameters);
  const Ensemble ensemble = ensemble_for(scene, reference.times, making);
  const nlohmann::json document = parse_document(read_file(path, "reference"), path);
  write_atomically(path, with_ensemble(document, ensemble).dump() + "\n");
  making.done();
  std::cout << reference.scene << ":\n";
  print_ensemble(std::cout, ensemble);
  std::cout << path << std::endl;
}

bool wants_ensemble(const Reference& reference, bool again) {
  const Ensemble& ensemble = reference.ensemble;
  const bool there = ensemble.known() || !ensemble.unknown_because.empty();
  return !reference.exact && (again || !there) &&
         is_cloth(find_scene(reference.scene)->build(reference.parameters));
}

// Sweeps of one scene at the sizes that were given.
std::vector<SceneOfReference> given_scenes(const SweepOptions& options) {
  if (options.scene.empty())
    throw UsageError("--n and --set go with --scene: of which scene is the reference to be?");
  const std::string scene = scene_of(options);
  const auto type = find_scene(scene);
  if (!type) throw UsageError("there is no scene '" + scene + "'; `bench list scenes` names them");
  SceneParameters given = parameters_of(options);
  std::vector<SceneOfReference> scenes;
  if (options.n.empty()) scenes.emplace_back(scene, complete_parameters(*type, given));
  for (const double n : numbers_of("--n", options.n, Bounds::whole_number(2))) {
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
  ReferenceFolder nothing("");
  return without_reference(plan(suite, {}), nothing);
}

struct ReferenceOptions {
  SweepOptions options;
  bool again = false, ensemble = false;
  double finest = 0;
};

// Makes what is missing, or all of it: references, and ensembles of those that are there.
int make_references(const ReferenceOptions& given) {
  const SweepOptions& options = given.options;
  if (given.ensemble && given.finest > 0)
    throw UsageError("--finest does not go with --ensemble, whose runs have a step of their own");
  const bool one_scene = !options.n.empty() || !parameters_of(options).empty() ||
                         options.scene.starts_with("mesh:");  // of no suite
  const std::string folder = source_path("results/references");
  ReferenceFolder references(folder);
  bool nothing = true;
  for (const auto& [scene, parameters] :
       one_scene ? given_scenes(options) : scenes_of_suite(options)) {
    const std::string path = folder + "/" + reference_name(scene, parameters);
    const auto stored = references.find(scene, parameters);
    if (!given.ensemble && (!stored || given.again)) {
      make_reference(path, scene, parameters, given.finest);
    } else if (stored && wants_ensemble(*stored, given.again)) {
      add_ensemble(path, *stored);
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

}  // namespace

Verb reference_verb() {
  return {"reference", "compute the trajectories and ensembles that errors are measured against",
          [](const Command& command) -> Action {
            const auto given = std::make_shared<ReferenceOptions>();
            add_scene_selection(command, given->options);
            command.flag("--again", given->again, "also what exists already");
            command.flag("--ensemble", given->ensemble,
                         "only ensembles of references that exist; their paths stay as they are");
            command.option("--finest", given->finest, "smallest step of step halving, s", "S")
                .positive();
            return [given] { return make_references(*given); };
          }};
}

}  // namespace harness
