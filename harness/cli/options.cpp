#include "harness/cli/options.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "harness/base/errors.h"
#include "harness/base/pattern.h"
#include "harness/base/text.h"
#include "solvers/registry.h"

namespace harness {

void SceneOptions::declare(const Command& to, const std::string& standard) {
  to.option("--scene", scene, "one of `bench list scenes`, or mesh:FILE.obj; default: " + standard,
            "SCENE");
  to.option("--n", n, "size of the scene; a resolution sweep takes several, e.g. 20,40,80",
            "N,...");
  to.repeatable("--set", set, "a parameter of the scene; repeatable", "NAME=NUMBER");
  to.option("--pins", pins,
            "of mesh:FILE.obj: which vertices are pinned, e.g. 'y > 1.2' or 'y > 1.2 and x < 0'",
            "WHERE");
  to.option("--collider", body, "of mesh:FILE.obj: the body, a closed mesh", "FILE.obj");
}

std::string SceneOptions::name() const { return with_mesh_parts(scene, pins, body); }

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
  if (!n.empty()) parameters[type->resolution] = one_number_of("--n", n, Bounds::whole_number(2));
  return harness::complete_parameters(*type, parameters);
}

void SelectionOptions::declare_scenes(const Command& to, const Command& of_suites) {
  to.option("--sweep", sweep, "axis: strain (limit), resolution, step or stability", "AXIS");
  add_profile(to, profile);
  SceneOptions::declare(of_suites, "all of the suite's");
  add_config(of_suites, config);
}

void SelectionOptions::declare(const Command& to, const Command& of_suites) {
  declare_scenes(to, of_suites);
  add_solver(to, solver);
  add_limits(of_suites, limits, "the suite's");
  add_filters(of_suites, filter, exclude);
}

void SweepOptions::declare(const Command& to, const Command& of_suites) {
  SelectionOptions::declare(to, of_suites);
  add_seed(to, seed, "of random orders");
  of_suites.option("--reps", reps, "samples of each point that may be best", "N",
                   Bounds::whole_number(1));
  add_timeout(of_suites, timeout, "the suite's");
  of_suites.option("--steps", steps,
                   "search (each solver's best step, default), all (the whole ladder) or adaptive "
                   "(one run from the coarsest step, halved where the solver refuses it)",
                   "HOW");
  of_suites.option("--finest", finest, "smallest step of the ladder instead of the suite's", "S",
                   Bounds::positive());
  of_suites.option("--finest-error", finest_error,
                   "search best steps for levels of error down to this one, over the scene's size, "
                   "instead of the suite's",
                   "E", Bounds::positive());
  of_suites.flag("--untimed", untimed,
                 "for counters and errors only: run at once, beside programs that take times; the "
                 "result is refused wherever times are read");
}

void add_results(const Command& to, Words& files, const std::string& help) {
  to.option("results", files, help, "RESULT.json ...");
  to.require({"results"});
}

void add_solver(const Command& to, std::string& solver) {
  to.alternatives(
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

void add_profile(const Command& to, std::string& profile) {
  to.option("--profile", profile, "one of `bench list suites`; default: " + profile, "NAME");
}

void add_config(const Command& to, std::string& config) {
  to.option("--config", config, "a suite of your own instead of a profile", "FILE");
}

void add_timeout(const Command& to, double& timeout, const std::string& standard) {
  to.option("--timeout", timeout, "seconds a run may take; default: " + standard, "S",
            Bounds::positive());
}

void add_seed(const Command& to, std::int64_t& seed, const std::string& help) {
  to.option("--seed", seed, help, "N", Bounds::exact_number());
}

void add_no_wait(const Command& to, bool& no_wait) {
  to.flag("--no-wait", no_wait,
          "stop instead of waiting if another program is taking times on this machine");
}

std::vector<std::string> profiles() { return {"quick", "default", "paper", "large"}; }

std::optional<Pattern> solver_pattern(const std::string& text, const Contestants& contestants) {
  if (text.empty()) return std::nullopt;
  std::vector<std::string> names = names_of(inextensible::backends());
  for (const Contestant& c : contestants) {
    if (!c.own_name()) names.push_back(c.name);
  }
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

std::vector<double> numbers_of(const std::string& option, const std::string& text,
                               const Bounds& bounds) {
  std::vector<double> numbers;
  std::istringstream list(text + ',');  // so that nothing behind the last comma is an item as well
  for (std::string item; std::getline(list, item, ',');) {
    const auto number = number_in(item);
    if (!number || !bounds.hold(*number))
      throw UsageError(option + " is '" + shortened(text) + "': '" + shortened(item, 20) +
                       "' must be " + bounds.text());
    numbers.push_back(*number);
  }
  return numbers;
}

double one_number_of(const std::string& option, const std::string& text, const Bounds& bounds) {
  const std::vector<double> numbers = numbers_of(option, text, bounds);
  if (numbers.size() != 1) throw UsageError(option + " is '" + text + "', must be one number");
  return numbers.front();
}

}  // namespace harness
