#include "harness/cli/shared_options.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/pattern.h"
#include "harness/base/text.h"
#include "harness/scenes/mesh_scenes.h"
#include "solvers/registry.h"

namespace harness {

void add_scene(const Command& to, SceneOptions& options, const std::string& standard) {
  to.option("--scene", options.scene,
            "one of `bench list scenes`, or mesh:FILE.obj; default: " + standard, "SCENE");
  to.option("--n", options.n, "size of the scene; a resolution sweep takes several, e.g. 20,40,80",
            "N,...");
  to.option("--set", options.parameters, "a parameter of the scene; repeatable", "NAME=NUMBER")
      .repeatable();
  to.option("--pins", options.pins,
            "of mesh:FILE.obj: which vertices are pinned, e.g. 'y > 1.2' or 'y > 1.2 and x < 0'",
            "WHERE");
  to.option("--collider", options.body, "of mesh:FILE.obj: the body, a closed mesh", "FILE.obj");
}

std::string scene_of(const SceneOptions& options) {
  return with_mesh_parts(options.scene, options.pins, options.body);
}

SceneParameters parameters_of(const SceneOptions& options) {
  SceneParameters parameters;
  for (const std::string& word : options.parameters) {
    const auto equals = word.find('=');
    char* end = nullptr;
    const std::string number = equals == std::string::npos ? "" : word.substr(equals + 1);
    const double value = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != '\0')
      throw UsageError("--set " + word + ": must be NAME=NUMBER, a parameter of the scene");
    parameters[word.substr(0, equals)] = value;
  }
  return parameters;
}

SceneParameters complete_parameters_of(const SceneOptions& options) {
  const std::string scene = scene_of(options);
  const auto type = find_scene(scene);
  if (!type) throw unknown_name("scene", scene, names_of(scene_types()));
  SceneParameters parameters = parameters_of(options);
  if (!options.n.empty()) {
    const std::vector<double> sizes = numbers_of("--n", options.n, Bounds::whole_number(2));
    if (sizes.size() != 1) throw UsageError("--n is '" + options.n + "', must be one size");
    parameters[type->resolution] = sizes.front();
  }
  return complete_parameters(*type, parameters);
}

Option add_solver(const Command& to, std::string& solver) {
  return to.alternatives(
      "--solver", solver,
      "only contestants whose whole name matches, e.g. shake,icd or 'yarn_projection.*'; "
      "repeatable");
}

void add_limits(const Command& to, std::string& limits, const std::string& standard) {
  to.option("--limit", limits,
            "strain limit, one or several, e.g. 0.01,0.001; default: " + standard, "STRAIN,...");
}

void add_filters(const Command& to, std::string& filter, std::string& exclude) {
  to.option("--filter", filter, "only points whose id contains a match", "REGEX");
  to.option("--exclude", exclude, "without points whose id contains a match", "REGEX");
}

void add_suite(const Command& to, std::string& profile, std::string& config) {
  to.option("--profile", profile, "one of `bench list suites`; default: " + profile, "NAME");
  to.option("--config", config, "a suite of your own instead of a profile", "FILE");
}

void add_timeout(const Command& to, double& timeout, const std::string& standard) {
  to.option("--timeout", timeout, "seconds a run may take; default: " + standard, "S").positive();
}

void add_no_plots(const Command& to, bool& no_plots) {
  to.flag("--no-plots", no_plots, "draw no figures");
}

void add_no_wait(const Command& to, bool& no_wait) {
  to.flag("--no-wait", no_wait,
          "stop instead of waiting if another program is taking times on this machine");
}

std::vector<std::string> profiles() { return {"quick", "default", "paper", "large"}; }

void check_profile(const std::string& name) {
  const auto known = profiles();
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw unknown_name("profile", name, known);
}

namespace {

// A pair that makes no sense gets its reason, any other name a suggestion.
UsageError no_solver(const std::string& name, const std::vector<std::string>& names) {
  const std::string reason = inextensible::why_no_pair(name);
  if (reason.empty()) return unknown_name("solver", name, names);
  return UsageError("there is no solver '" + name + "': " + reason);
}

}  // namespace

void check_solver_pattern(const std::string& text, const Contestants& contestants) {
  std::vector<std::string> names = names_of(inextensible::backends());
  for (const Contestant& c : contestants) {
    if (!c.own_name()) names.push_back(c.name);
  }
  const Pattern whole("--solver", text);
  for (const std::string& part : alternatives(text)) {
    const Pattern expression("--solver", part);
    if (std::none_of(names.begin(), names.end(),
                     [&](const std::string& name) { return matches(expression, name); }))
      throw no_solver(part, names);
  }
}

std::vector<double> numbers_of(const std::string& option, const std::string& text,
                               const Bounds& bounds) {
  std::vector<double> numbers;
  std::istringstream list(text + ',');  // so that nothing behind the last comma is an item as well
  for (std::string item; std::getline(list, item, ',');) {
    char* end = nullptr;
    const double number = std::strtod(item.c_str(), &end);
    if (item.empty() || *end != '\0' || !bounds.hold(number))
      throw UsageError(option + " is '" + shortened(text) + "': '" + shortened(item, 20) +
                       "' must be " + bounds.text());
    numbers.push_back(number);
  }
  return numbers;
}

double duration_of(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  const double scale = unit == "ms" ? 1e-3 : unit == "us" ? 1e-6 : unit == "s" ? 1 : 0;
  if (!(value > 0) || scale == 0)
    throw UsageError(option + " is '" + shortened(text, 40) +
                     "', must be such as 2ms, 500us or 0.002s");
  return value * scale;
}

}  // namespace harness
