// Options that several verbs have: each has one name, one grammar and one help.
#pragma once

#include <string>
#include <vector>

#include "harness/cli/command_line.h"
#include "harness/points/contestant.h"
#include "harness/scenes/scene.h"

namespace harness {

struct SceneOptions {
  std::string scene, n;                 // n: numbers between commas
  std::vector<std::string> parameters;  // NAME=NUMBER
  std::string pins, body;               // of a mesh
};
// standard: what is taken if the option is not given, here and below.
void add_scene(const Command& to, SceneOptions& options, const std::string& standard);
// These throw UsageError. parameters_of: those of --set.
std::string scene_of(const SceneOptions& options);
SceneParameters parameters_of(const SceneOptions& options);
// Options that choose a scene of one size.
SceneParameters complete_parameters_of(const SceneOptions& options);

Option add_solver(const Command& to, std::string& solver);
void add_limits(const Command& to, std::string& limits, const std::string& standard);
void add_filters(const Command& to, std::string& filter, std::string& exclude);
void add_suite(const Command& to, std::string& profile, std::string& config);
void add_timeout(const Command& to, double& timeout, const std::string& standard);
void add_no_plots(const Command& to, bool& no_plots);
// Options of verbs that take times.
void add_no_wait(const Command& to, bool& no_wait);

std::vector<std::string> profiles();
// All of these throw UsageError for what does not exist.
void check_profile(const std::string& name);
// A regular expression, each of whose alternatives must match the name of some solver, or of some
// contestant.
void check_solver_pattern(const std::string& text, const Contestants& contestants = {});
// Numbers of a list between commas, "20,40,80". Throws UsageError, naming the option.
std::vector<double> numbers_of(const std::string& option, const std::string& text,
                               const Bounds& bounds);
// Seconds of "2ms", "500us" or "0.002s"; throws UsageError.
double duration_of(const std::string& option, const std::string& text);

}  // namespace harness
