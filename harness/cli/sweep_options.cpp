#include "harness/cli/sweep_options.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/base/paths.h"
#include "harness/base/text.h"
#include "harness/judge/reference_file.h"

namespace harness {

using nlohmann::json;

namespace {

// "5" or "5..40".
std::pair<int, int> parse_reps(const std::string& text) {
  int least = 0, most = 0;
  char extra = 0;
  const bool whole = has_form(text, R"(\d{1,4}(\.\.\d{1,4})?)");
  const int numbers = whole ? std::sscanf(text.c_str(), "%d..%d%c", &least, &most, &extra) : 0;
  if (least < 1)
    throw UsageError("--reps is '" + shortened(text) +
                     "', must be a number from 1 on, or two: 5..40");
  if (numbers == 2 && most < least)
    throw UsageError("--reps is '" + text + "', whose second number is below the first");
  return {least, most};
}

void check_longest_step(const Suite& suite) {
  for (const SweepSpec& sweep : suite.sweeps) {
    if (sweep.coarsest > longest_step * (1 + 1e-9))
      throw UsageError("the ladder of " + sweep.scene + " begins at " +
                       number_text(sweep.coarsest) +
                       " s ('steps': 'coarsest'), must be a frame, 1/24 s, at most");
  }
}

// For all sweeps a ladder that ends earlier or later.
void cut_ladders(Suite& suite, double finest) {
  for (SweepSpec& sweep : suite.sweeps) {
    if (sweep.adaptive)
      throw UsageError("--finest does not go with adaptive steps, which have no ladder");
    if (finest > sweep.coarsest)
      throw UsageError("--finest " + number_text(finest) + " leaves no step: the ladder of " +
                       sweep.scene + " begins at " + number_text(sweep.coarsest) + " s");
    sweep.finest = finest;
  }
}

}  // namespace

void add_scene_selection(const Command& to, SweepOptions& options) {
  to.option("--sweep", options.sweep, "axis: strain (limit), resolution, step or stability",
            "AXIS");
  add_scene(to, options, "all of the suite's");
  add_suite(to, options.profile, options.config);
}

void add_selection(const Command& to, SweepOptions& options) {
  add_scene_selection(to, options);
  add_limits(to, options.limits, "the suite's");
  add_solver(to, options.solver);
  add_filters(to, options.filter, options.exclude);
}

void add_measurement(const Command& to, SweepOptions& options) {
  to.option(
      "--reps", options.reps,
      "samples of each point that may be best; 7..40: more until the median is known to --rel-ci",
      "N");
  to.option("--rel-ci", options.rel_ci,
            "half width of the median's 95 % confidence interval over the median, default 0.02",
            "R")
      .positive();
  add_timeout(to, options.timeout, "the suite's");
  to.option("--steps", options.steps,
            "search (each solver's best step, default), all (the whole ladder) or adaptive "
            "(one run from the coarsest step, halved where the solver refuses it)",
            "HOW");
  to.option("--finest", options.finest, "smallest step of the ladder instead of the suite's", "S")
      .positive();
  to.option(
        "--finest-error", options.finest_error,
        "search best steps for levels of error down to this one, over the scene's size, instead of "
        "the suite's",
        "E")
      .positive();
  to.option("--seed", options.seed, "of random orders", "N").holds(Bounds::exact_number());
  to.flag(
      "--untimed", options.untimed,
      "for counters and errors only: run at once, beside programs that take times; the result is "
      "refused wherever times are read");
}

std::string suite_path(const SweepOptions& options) {
  if (!options.scene.empty() && !find_scene(options.scene))
    throw unknown_name("scene", options.scene, names_of(scene_types()));
  if (!options.config.empty()) return options.config;
  check_profile(options.profile);
  return source_path("configs/" + options.profile + ".json");
}

namespace {

bool is(const json& sweep, const char* key, const std::string& value) {
  return sweep.is_object() && sweep.value(key, json()) == value;
}

// A scene that the suite has not takes the place of its first sweep of that kind, at the size that
// the scene has by itself.
void put_in_scene(json& sweeps, const SweepOptions& options) {
  const auto of_kind = [&](const json& s) { return is(s, "sweep", options.sweep); };
  if (options.scene.empty() || std::any_of(sweeps.begin(), sweeps.end(), [&](const json& s) {
        return of_kind(s) && is(s, "scene", options.scene);
      }))
    return;
  const auto first = std::find_if(sweeps.begin(), sweeps.end(), of_kind);
  if (first == sweeps.end()) return;
  json sweep = *first;
  sweep["scene"] = options.scene;
  for (const char* key : {"scene_parameters", "resolutions", "solver_options", "steps"})
    sweep.erase(key);
  if (options.sweep == "resolution" && options.n.empty())
    throw UsageError("the suite has no resolutions of scene '" + options.scene + "': give --n");
  sweeps.push_back(std::move(sweep));
}

// The suite with what the options say instead: it then is one like any other, checked as a whole.
Suite edited_suite(const std::string& path, const SweepOptions& options) {
  const std::string text = read_file(path, "suite");
  const SceneParameters given = parameters_of(options);
  if (!given.empty() && options.scene.empty())
    throw UsageError("--set goes with --scene: of which scene is the parameter?");
  if (options.n.empty() && options.limits.empty() && options.scene.empty())
    return parse_suite(text, path);
  json document = parse_commented(text, path);
  if (!document.is_object() || !document.contains("sweeps") || !document["sweeps"].is_array())
    return parse_suite(text, path);  // which says what is wrong
  json& sweeps = document["sweeps"];
  put_in_scene(sweeps, options);
  for (json& sweep : sweeps) {
    if (!is(sweep, "sweep", options.sweep)) continue;
    if (is(sweep, "scene", options.scene)) {
      for (const auto& [name, value] : given) sweep["scene_parameters"][name] = value;
    }
    if (!options.limits.empty()) {
      const json limits = numbers_of("--limit", options.limits, Bounds::strain());
      if (options.sweep == "resolution" && limits.size() > 1)
        throw UsageError("--limit: a resolution sweep has one");
      sweep.erase("limit");
      sweep["limits"] = limits;
    }
    if (options.n.empty()) continue;
    const json sizes = numbers_of("--n", options.n, Bounds::whole_number(2));
    if (options.sweep != "resolution" && sizes.size() > 1)
      throw UsageError("--n: a " + options.sweep + " sweep has one size");
    const auto type = find_scene(sweep.value("scene", ""));
    if (type && sweep.contains("scene_parameters"))
      sweep["scene_parameters"].erase(type->resolution);
    sweep["resolutions"] = sizes;
  }
  return parse_suite(document.dump(), path);
}

}  // namespace

Suite load_suite(const SweepOptions& given) {
  SweepOptions options = given;
  options.scene = scene_of(given);
  const std::string path = suite_path(options);
  Suite suite = edited_suite(path, options);
  if (!options.solver.empty()) check_solver_pattern(options.solver, contestants_of(suite));
  std::vector<std::string> kinds = sweep_kinds();
  if (std::find(kinds.begin(), kinds.end(), options.sweep) == kinds.end()) {
    kinds.emplace_back("stability");
    throw unknown_name("sweep", options.sweep, kinds);
  }
  std::erase_if(suite.sweeps, [&](const SweepSpec& s) {
    return s.sweep != options.sweep || (!options.scene.empty() && s.scene != options.scene);
  });
  if (suite.sweeps.empty())
    throw UsageError("'" + path + "' has no such sweep: --sweep " + options.sweep + " --scene " +
                     options.scene);
  if (options.steps != "search" && options.steps != "adaptive" && options.steps != "all")
    throw unknown_name("choice of steps", options.steps, {"search", "adaptive", "all"});
  check_longest_step(suite);
  if (options.steps == "adaptive") {
    if (options.sweep == "step")
      throw UsageError("--steps adaptive does not go with --sweep step, whose steps are fixed");
    for (SweepSpec& sweep : suite.sweeps) sweep.adaptive = true;
    suite.name += "-adaptive";  // files and figures of their own
  } else if (options.steps == "all" && options.sweep != "step") {
    for (SweepSpec& sweep : suite.sweeps) sweep.every_step = true;
    suite.name += "-all";
  }
  if (!options.reps.empty()) std::tie(suite.reps, suite.most_reps) = parse_reps(options.reps);
  if (options.rel_ci > 0) suite.rel_ci = options.rel_ci;
  if (options.finest > 0) cut_ladders(suite, options.finest);
  if (options.timeout > 0) suite.timeout = options.timeout;
  // Where times mean nothing, no run is stopped for being slower than another contestant's.
  if (options.untimed) suite.far_behind = std::numeric_limits<double>::infinity();
  if (options.finest_error > 0) suite.finest_error = options.finest_error;
  if (options.seed >= 0) suite.seed = static_cast<std::uint64_t>(options.seed);
  // A solver that is no contestant joins when it is asked for by its own name.
  if (const auto* backend = inextensible::find_backend(options.solver);
      backend && !backend->contestant) {
    for (SweepSpec& sweep : suite.sweeps) sweep.contestants = {{options.solver, options.solver}};
  }
  Contestants left = contestants_of(suite);
  if (find_contestant(left, suite.same) == left.end()) suite.same.clear();
  return suite;
}

SweepFilters make_filters(const SweepOptions& options) {
  SweepFilters filters;
  if (!options.solver.empty()) filters.solver = Pattern("--solver", options.solver);
  if (!options.filter.empty()) filters.include = Pattern("--filter", options.filter);
  if (!options.exclude.empty()) filters.exclude = Pattern("--exclude", options.exclude);
  return filters;
}

std::vector<std::pair<std::string, SceneParameters>> without_reference(
    const std::vector<Search>& searches, ReferenceFolder& references) {
  std::map<std::string, std::pair<std::string, SceneParameters>> missing;
  for (const Search& search : searches) {
    const auto& [scene, parameters] = std::pair(search.base.scene, search.base.scene_parameters);
    if (!references.find(scene, parameters))
      missing[reference_name(scene, parameters)] = {scene, parameters};
  }
  std::vector<std::pair<std::string, SceneParameters>> list;
  list.reserve(missing.size());
  for (auto& [name, scene] : missing) list.push_back(std::move(scene));
  return list;
}

}  // namespace harness
