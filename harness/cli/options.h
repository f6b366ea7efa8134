// Options that several verbs have: each has one name, one grammar and one help. What they are about
// is checked here, and what is wrong is a UsageError.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/cli/command_line.h"
#include "harness/points/contestant.h"
#include "harness/run/sweep.h"
#include "harness/scenes/scene.h"

namespace harness {

// standard: what is taken if the option is not given, here and below.
struct SceneOptions {
  std::string scene, n;    // n: numbers between commas
  Words set;               // NAME=NUMBER
  std::string pins, body;  // of a mesh

  void declare(const Command& to, const std::string& standard);
  std::string name() const;                     // of the scene, with the parts of a mesh
  SceneParameters given_parameters() const;     // of --set
  SceneParameters complete_parameters() const;  // where one scene of one size is chosen
};

// What selects the runs of a sweep.
struct SelectionOptions : SceneOptions {  // n: instead of the suite's
  std::string sweep, solver, filter, exclude, config, profile = "default";
  std::string limits;  // numbers between commas, instead of the suite's

  // of_suites: of those that hard cases do not have.
  void declare_scenes(const Command& to, const Command& of_suites);
  void declare(const Command& to, const Command& of_suites);
};

// How it is run, too.
struct SweepOptions : SelectionOptions {
  std::string steps = "search";
  int reps = 0;
  double timeout = 0, finest_error = 0, finest = 0;
  std::int64_t seed = -1;
  bool untimed = false;  // times are not used: does not wait for others that take times

  void declare(const Command& to, const Command& of_suites);
};

void add_results(const Command& to, Words& files, const std::string& help);
void add_solver(const Command& to, std::string& solver);
void add_limits(const Command& to, std::string& limits, const std::string& standard);
void add_filters(const Command& to, std::string& filter, std::string& exclude);
void add_profile(const Command& to, std::string& profile);
void add_config(const Command& to, std::string& config);
void add_timeout(const Command& to, double& timeout, const std::string& standard);
void add_seed(const Command& to, std::int64_t& seed, const std::string& help);
void add_no_wait(const Command& to, bool& no_wait);

std::vector<std::string> profiles();
// Both: none for "". Each alternative of the first must match the name of some solver or of some
// contestant.
std::optional<Pattern> solver_pattern(const std::string& text, const Contestants& contestants = {});
std::optional<Pattern> pattern_of(const std::string& option, const std::string& text);
// Numbers of a list between commas, "20,40,80".
std::vector<double> numbers_of(const std::string& option, const std::string& text,
                               const Bounds& bounds);
double one_number_of(const std::string& option, const std::string& text, const Bounds& bounds);

std::string suite_path(const SelectionOptions& options);
Suite load_suite(const SweepOptions& options);
SweepFilters filters_of(const SelectionOptions& options);
// Scenes of the plan without a reference, by its file's name: their points carry no trajectory
// error.
using SceneOfReference = std::pair<std::string, SceneParameters>;
std::map<std::string, SceneOfReference> without_reference(const std::vector<Search>& searches,
                                                          ReferenceFolder& references);
// The methods that made it, and for how long the motion is known.
std::string reference_text(const Reference& reference);

}  // namespace harness
