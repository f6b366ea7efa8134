// bench reference, export and judge: the trajectories that errors are measured against, scenes for
// other programs, and what these made of them.
#include "harness/analysis/measured_point.h"
#include "harness/cli/command.h"
#include "harness/judge/reference_routes.h"
#include "harness/judge/trajectory.h"
#include "harness/points/context.h"
#include "harness/points/result_file.h"
#include "harness/scenes/scene_folder.h"

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

struct Export : SceneOptions {
  std::string out;

  void declare(const Command& command) {
    SceneOptions::declare(command, "none");
    command.option("--out", out, "a folder that does not exist yet", "FOLDER");
    command.require({"--scene", "--out"});
  }

  int run() {
    const auto type = checked_scene(name());
    const SceneParameters parameters = complete_parameters();
    std::error_code error;
    if (std::filesystem::exists(out, error))
      throw UsageError("--out '" + out + "' exists already; give another folder");
    const auto reference = ReferenceFolder::usual()->find(type->name, parameters);
    const std::string partial = out + ".partial";
    std::filesystem::remove_all(partial, error);
    if (!std::filesystem::create_directory(partial, error))
      throw FileError(out, "make folder", error.message());
    try {
      json said = about(*type, parameters);
      if (reference) said["reference"] = "reference.npz";
      write_scene(partial, type->build(parameters), said);
    } catch (const std::invalid_argument& impossible) {  // parameters that make no scene
      std::filesystem::remove_all(partial, error);
      throw UsageError(impossible.what());
    }
    if (reference) write_atomically(partial + "/reference.npz", npz_bytes(arrays_of(*reference)));
    std::filesystem::rename(partial, out);
    std::cout << out << ": " << type->counts(parameters).first << " vertices, "
              << (reference ? reference_text(*reference) : "no reference (bench reference)")
              << '\n';
    return success;
  }
};

struct JudgeVerb {
  std::string scene, name, out;
  Words files;
  double rate = 0, seconds = 0, limit = 0;

  void declare(const Command& command) {
    command.option("folder", scene, "a scene that bench export wrote", "FOLDER");
    command.option("trajectory", files, "one .npz file, or numbered .obj files", "FILE ...");
    command.require({"folder", "trajectory"});
    command.option("--fps", rate, "frames a second, where the file has no times", "N",
                   Bounds::positive());
    command.option("--seconds", seconds, "that the program took for the whole motion", "S",
                   Bounds::positive());
    command.option("--limit", limit, "strain limit that it claims; default: the tightest it keeps",
                   "STRAIN", Bounds::strain());
    command.option("--name", name, "in tables and figures: a-z, 0-9 and _; default: trajectory",
                   "NAME");
    command.option("--out", out, "a result file, for bench show and plot beside others", "FILE");
  }

  PointResult judged(const PointSpec& given, const Scene& built) const {
    RunLimits limits{.interrupted = interrupted, .timed = false};
    limits.references = ReferenceFolder::usual();
    limits.scene = &built;
    PointResult point = run_point(given, limits);
    // Without a limit: the tightest of the usual ones that it keeps, which changes nothing else.
    for (const double usual : {0.1, 0.05, 0.02, 0.01, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4})
      if (limit == 0 && point.measures.max_strain <= usual) point.spec.strain_limit = usual;
    static_cast<Samples&>(point) = {};
    if (seconds > 0 && point.ok()) {
      point.samples = {seconds / built.duration};
      point.best = true;
    }
    return point;
  }

  static void print(const PointResult& point) {
    const Measures& m = point.measures;
    std::cout << "verdict: " << to_string(point.status)
              << (point.detail.empty() ? "" : " (" + point.detail + ")") << '\n'
              << "strain: " << analysis::percent(m.max_strain) << " largest, "
              << analysis::percent(m.p99_strain) << " for 99 % of the edges\n"
              << "error of the motion: ";
    if (std::isnan(m.trajectory)) {
      std::cout << "not known, " << m.unknown_because << '\n';
    } else {
      std::cout << analysis::percent(m.trajectory) << " at worst, "
                << analysis::percent(m.trajectory_mean)
                << " on average, until t = " << m.error_until << " s; over time:";
      for (std::size_t k = 4; k < m.error_series.size(); k += 5)
        std::cout << ' ' << analysis::percent(m.error_series[k].error) << " at "
                  << m.error_series[k].time << " s" << (k + 5 < m.error_series.size() ? "," : "");
      std::cout << '\n';
    }
    std::cout << "energy: " << number_text(m.energy_gain, 3)
              << " of weight times size above the start's at most\n";
  }

  int run(const Words& typed) {
    if (!names_folder(scene))
      throw UsageError("'" + scene + "' is no scene that bench export wrote: no scene.json there");
    if (name.empty()) name = "trajectory";
    const auto type = find_scene(scene);
    PointSpec spec{
        .sweep = "strain", .scene = type->name, .scene_parameters = complete_parameters(*type, {})};
    spec.resolution = static_cast<int>(spec.scene_parameters.at(type->resolution));
    std::tie(spec.vertices, spec.constraints) = type->counts(spec.scene_parameters);
    spec.contestant = spec.solver = name;
    const Scene built = type->build(spec.scene_parameters);
    const auto trajectory = std::make_shared<const Trajectory>(read_trajectory(files, built, rate));
    spec.step = trajectory->interval;
    spec.strain_limit = limit > 0 ? limit : 0.1;
    const std::string label = name + " (time as reported)";
    try {
      const Backend rows[] = {playback(name.c_str(), label.c_str(), trajectory)};
      inextensible::add_backends(rows);
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("--name: ") + error.what());
    }
    const PointResult point = judged(spec, built);
    print(point);
    std::cout << worst_places(*trajectory, built);
    if (!out.empty()) {
      Suite suite;
      suite.name = suite.profile = "judged";
      suite.sweeps = {{.sweep = spec.sweep,
                       .scene = spec.scene,
                       .contestants = {{name, name}},
                       .limits = {point.spec.strain_limit},
                       .resolutions = {spec.resolution},
                       .coarsest = spec.step,
                       .finest = spec.step}};
      json context = machine_context();
      context["timed"] = seconds > 0;
      context["selection"] = {{"solver", ""}, {"filter", ""}, {"exclude", ""}};
      const auto document = result_document(context, suite, typed, true, {point});
      check_result(document, out);
      write_atomically(out, result_text(document));
    }
    return point.ok() ? success : unexpected_outcome;
  }
};

}  // namespace

Action reference_verb(const Command& command) { return verb<ReferenceVerb>(command); }
Action export_verb(const Command& command) { return verb<Export>(command); }
Action judge_verb(const Command& command) { return verb<JudgeVerb>(command); }

}  // namespace harness
