#include "harness/cli/command.h"
#include "harness/scenes/scene_folder.h"

namespace harness {

void SceneOptions::declare(const Command& to, const std::string& standard) {
  if (!standard.empty()) {
    to.option("--scene", scene,
              "one of `bench list scenes`, mesh:FILE.obj, or a folder of bench export; default: " +
                  standard,
              "SCENE");
    to.option("--n", n, "size of the scene; a resolution sweep takes several, e.g. 20,40,80", "N",
              Bounds::whole_number(least_n));
    to.repeatable("--set", set, "a parameter of the scene; repeatable", "NAME=NUMBER");
  }
  const auto part = [&](const std::string& name, const std::string& help, const char* type) {
    to.option("--" + name, mesh[name], "of mesh:FILE.obj: " + help, type);
  };
  part("pins",
       "which vertices are pinned, e.g. 'y > 1.2 and x <= 0' or 'v1 or near(1:2:0)', a vertex of "
       "the file and the nearest one",
       "WHERE");
  to.repeatable("--collider", body, "of mesh:FILE.obj: the body, a closed mesh; repeatable",
                "FILE.obj");
  to.repeatable("--collider-then", body_then,
                "of mesh:FILE.obj: the bodies moved and turned as one, at the end of the run; "
                "repeatable, at equal intervals",
                "FILE.obj");
  part("thickness", "bodies are open surfaces, seen from the front, this thick", "DISTANCE");
  part("triangles",
       "midpoints (each triangle keeps its shape) or springs (default: what makes no quad is held "
       "by springs)",
       "HOW");
  part("floor", "a floor at this height, in the file's unit", "Y");
  part("load", "the vertices that bear the weight `load` (--set load=KG), as pins", "WHERE");
  part("rest", "the unstretched shape, with the same faces and lines", "FILE.obj");
  part("weld", "corners this close, in the file's unit, are one vertex; 0: none", "DISTANCE");
}

std::string SceneOptions::name() const {
  if (names_folder(scene)) return find_scene(scene)->name;
  std::vector<std::pair<std::string, std::string>> parts(mesh.begin(), mesh.end());
  for (const auto& [name, files] : {std::pair("body", &body), {"body_then", &body_then}}) {
    std::string& all = parts.emplace_back(name, "").second;
    for (const std::string& file : *files) append(all, file, ";");
  }
  return with_mesh_parts(scene, parts);
}

SceneParameters SceneOptions::given_parameters() const {
  SceneParameters parameters;
  for (const std::string& word : set) {
    const auto equals = word.find('=');
    const auto number =
        equals == std::string::npos ? std::nullopt : number_in(word.substr(equals + 1));
    if (!number)
      throw UsageError("--set " + word + ": must be NAME=NUMBER, a parameter of the scene");
    parameters[word.substr(0, equals)] = *number;
  }
  return parameters;
}

SceneParameters SceneOptions::complete_parameters() const {
  const auto type = checked_scene(name());
  SceneParameters parameters = given_parameters();
  if (n.size() > 1) throw UsageError("--n: one scene has one size");
  if (!n.empty()) parameters[type->resolution] = n.front();
  return harness::complete_parameters(*type, parameters);
}

void SweepOptions::declare_scenes(const Command& to, const Command& of_suites) {
  to.option("--sweep", sweep, "axis: strain (limit), resolution, step or stability", "AXIS");
  add_suite(to, of_suites, profile, config);
  SceneOptions::declare(of_suites, "all of the suite's");
}

void SweepOptions::declare(const Command& to, const Command& of_suites) {
  declare_scenes(to, of_suites);
  add_solver(to, solver);
  add_limits(of_suites, limits, "the suite's");
  add_filters(of_suites, filter, exclude);
  to.option("--seed", seed, "of random orders", "N", Bounds::exact_number());
  of_suites.option("--reps", reps, "samples of each point that may be best", "N",
                   Bounds::whole_number(1));
  add_timeout(of_suites, timeout, "the suite's");
  of_suites.option("--steps", steps,
                   "search (each solver's best step, default) or all (the whole ladder)", "HOW");
  of_suites.option("--finest", finest, "smallest step of the ladder instead of the suite's", "S",
                   Bounds::positive());
  of_suites.option("--finest-error", finest_error,
                   "finest level of error, over the scene's size, that best steps are searched for",
                   "E", Bounds::positive());
  of_suites.flag("--untimed", untimed,
                 "for counters and errors only: runs beside other programs; its times are refused");
}

void add_results(const Command& to, Words& files, const std::string& help) {
  to.option("results", files, help, "RESULT.json ...");
  to.require({"results"});
}

void add_solver(const Command& to, std::string& solver) {
  to.alternatives(
      "--solver", solver,
      "contestants whose whole name matches, e.g. shake,icd or 'yarn_projection.*'; repeatable");
}

void add_limits(const Command& to, Numbers& limits, const std::string& standard) {
  to.option("--limit", limits,
            "strain limit, one or several, e.g. 0.01,0.001; default: " + standard, "STRAIN",
            Bounds::strain());
}

void add_filters(const Command& to, std::string& filter, std::string& exclude) {
  to.option("--filter", filter, "only points whose id contains a match", "REGEX");
  to.option("--exclude", exclude, "without points whose id contains a match", "REGEX");
}

void add_suite(const Command& to, const Command& of_suites, std::string& profile,
               std::string& config) {
  to.option("--profile", profile, "one of `bench list suites`; default: " + profile, "NAME");
  of_suites.option("--config", config, "a suite of your own instead of a profile", "FILE");
}

void add_timeout(const Command& to, double& timeout, const std::string& standard) {
  to.option("--timeout", timeout, "seconds a run may take; default: " + standard, "S",
            Bounds::positive());
}

void add_no_wait(const Command& to, bool& no_wait) {
  to.flag("--no-wait", no_wait,
          "stop instead of waiting if another program is timing runs on this machine");
}

std::vector<std::string> profiles() { return {"quick", "default", "pairs", "paper", "large"}; }

std::optional<Pattern> solver_pattern(const std::string& text, const Contestants& contestants) {
  if (text.empty()) return std::nullopt;
  std::vector<std::string> names = names_of(backends());
  for (const Contestant& c : contestants)
    if (!c.own_name()) names.push_back(c.name);
  const Pattern whole("--solver", text);
  for (const std::string& part : alternatives(text)) {
    const Pattern expression("--solver", part);
    if (std::ranges::none_of(names,
                             [&](const std::string& name) { return matches(expression, name); }))
      throw no_solver(part, names);
  }
  return whole;
}

std::optional<Pattern> pattern_of(const std::string& option, const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(Pattern(option, text));
}

// ---- The suite that a sweep runs: a profile's or one's own, as the options change it ----

namespace {

// A scene missing from the suite gets a copy of the first sweep of that kind, at its default size.
void put_in_scene(json& sweeps, const SweepOptions& options) {
  const auto of_kind = [&](const json& s) { return s["sweep"] == options.sweep; };
  if (options.scene.empty() || std::ranges::any_of(sweeps, [&](const json& s) {
        return of_kind(s) && s["scene"] == options.scene;
      }))
    return;
  const auto first = std::ranges::find_if(sweeps, of_kind);
  if (first == sweeps.end()) return;
  json sweep = *first;
  sweep["scene"] = options.scene;
  for (const char* key : {"scene_parameters", "resolutions", "solver_options", "steps"})
    sweep.erase(key);
  if (options.sweep == "resolution" && options.n.empty())
    throw UsageError("the suite has no resolutions of scene '" + options.scene + "': give --n");
  sweeps.push_back(std::move(sweep));
}

Suite edited_suite(const std::string& path, const SweepOptions& options) {
  const SceneParameters given = options.given_parameters();
  if (!given.empty() && options.scene.empty()) throw UsageError("--set goes with --scene");
  json document = suite_document(read_file(path, "suite"), path);
  json& sweeps = document["sweeps"];
  put_in_scene(sweeps, options);
  for (json& sweep : sweeps) {
    if (sweep["sweep"] != options.sweep) continue;
    if (sweep["scene"] == options.scene)
      for (const auto& [name, value] : given) sweep["scene_parameters"][name] = value;
    if (!options.limits.empty()) {
      if (options.sweep == "resolution" && options.limits.size() > 1)
        throw UsageError("--limit: a resolution sweep has one");
      sweep.erase("limit");
      sweep["limits"] = options.limits;
    }
    if (options.n.empty()) continue;
    if (options.sweep != "resolution" && options.n.size() > 1)
      throw UsageError("--n: a " + options.sweep + " sweep has one size");
    const auto type = find_scene(sweep["scene"].get<std::string>());
    if (type && sweep.contains("scene_parameters"))
      sweep["scene_parameters"].erase(type->resolution);
    sweep["resolutions"] = options.n;
  }
  return suite_of(document, path);
}

}  // namespace

std::string suite_path(const SweepOptions& options) {
  if (!options.scene.empty()) (void)checked_scene(options.scene);
  if (!options.config.empty()) return options.config;
  check_known("profile", options.profile, profiles());
  return source_path("configs/" + options.profile + ".json");
}

Suite load_suite(const SweepOptions& given) {
  SweepOptions options = given;
  options.scene = given.name();
  const std::string path = suite_path(options);
  Suite suite = edited_suite(path, options);
  (void)solver_pattern(options.solver, contestants_of(suite));
  std::vector<std::string> kinds = sweep_kinds();
  kinds.emplace_back("stability");
  check_known("sweep", options.sweep, kinds);
  std::erase_if(suite.sweeps, [&](const SweepSpec& s) {
    return s.sweep != options.sweep || (!options.scene.empty() && s.scene != options.scene);
  });
  if (suite.sweeps.empty())
    throw UsageError("'" + path + "' has no such sweep: --sweep " + options.sweep + " --scene " +
                     options.scene);
  check_known("choice of steps", options.steps, {"search", "all"});
  if (options.steps == "all" && options.sweep != "step") {
    for (SweepSpec& sweep : suite.sweeps) sweep.every_step = true;
    suite.name += "-all";  // separate files and figures
  }
  if (options.untimed && options.reps > 1)
    throw UsageError("--reps and --untimed exclude each other: without times one run is enough");
  if (options.reps > 0 || options.untimed) suite.reps = std::max(options.reps, 1);
  if (const double finest = options.finest; finest > 0)
    for (SweepSpec& sweep : suite.sweeps) {
      if (finest > sweep.coarsest)
        throw UsageError(concat("--finest ", finest, " leaves no step: the ladder of ", sweep.scene,
                                " begins at ", sweep.coarsest, " s"));
      sweep.finest = finest;
    }
  if (options.timeout > 0) suite.timeout = options.timeout;
  // Meaningless times must not stop a run for being slower than another contestant's.
  if (options.untimed) suite.far_behind = std::numeric_limits<double>::infinity();
  if (options.finest_error > 0) suite.finest_error = options.finest_error;
  if (options.seed >= 0) suite.seed = static_cast<std::uint64_t>(options.seed);
  // A solver that is not a contestant takes part only if named in full.
  if (const auto* backend = find_backend(options.solver); backend && !backend->contestant)
    for (SweepSpec& sweep : suite.sweeps) sweep.contestants = {{options.solver, options.solver}};
  Contestants left = contestants_of(suite);
  if (find_contestant(left, suite.same) == left.end()) suite.same.clear();
  return suite;
}

SweepFilters filters_of(const SweepOptions& options) {
  return {pattern_of("--solver", options.solver), pattern_of("--filter", options.filter),
          pattern_of("--exclude", options.exclude)};
}

std::map<std::string, SceneOfReference> without_reference(const std::vector<Search>& searches,
                                                          ReferenceFolder& references) {
  std::map<std::string, SceneOfReference> missing;
  for (const Search& search : searches) {
    const SceneOfReference scene{search.base.scene, search.base.scene_parameters};
    if (!references.find(scene.first, scene.second))
      missing.emplace(reference_name(scene.first, scene.second), scene);
  }
  return missing;
}

std::string reference_text(const Reference& reference) {
  return concat(reference.method, " against ", reference.second_method, ": known to ",
                100 * headline_error, " % for ", reference.known_until(headline_error), " of ",
                reference.duration(), " s");
}

}  // namespace harness
