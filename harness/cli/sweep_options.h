// The options that select what a sweep runs, shared by several commands.
#pragma once

#include <string>
#include <vector>

#include "harness/cli/command_line.h"
#include "harness/run/sweep.h"

namespace harness {

// What the command line says of a scene besides its name.
struct SceneWords {
  std::vector<std::string> parameters;  // NAME=NUMBER
  std::string pins, body;               // of a mesh
};
void add_scene_words(const Command& to, SceneWords& words);
// Throw UsageError.
std::string scene_of(const std::string& scene, const SceneWords& words);
SceneParameters parameters_of(const SceneWords& words);

struct SweepOptions {
  std::string sweep, scene, solver, filter, exclude, config, profile = "default", step = "search";
  std::string reps;       // "5", or "5..40" with rel_ci
  std::string n, limits;  // numbers between commas, in place of the suite's
  SceneWords scene_words;
  double timeout = 0, finest_error = 0, rel_ci = 0, finest = 0;
  std::int64_t seed = -1;
  bool untimed = false;  // nobody will read the times: no turn to be waited for
};

// --sweep, --scene with its words, --n, --profile and --config.
void add_scene_selection(const Command& to, SweepOptions& options);
// These, --limit, --solver, --filter and --exclude.
void add_selection(const Command& to, SweepOptions& options);

// --reps, --rel-ci, --timeout, --step, --finest-error, --seed and --untimed.
void add_measurement(const Command& to, SweepOptions& options);

std::vector<std::string> profiles();
// All of these throw UsageError for what does not exist.
void check_profile(const std::string& name);
// A regular expression, each of whose alternatives must match the name of some solver, or of some
// contestant.
void check_solver_pattern(const std::string& text, const Contestants& contestants = {});
// Of a list between commas, "20,40,80". Throws UsageError, naming the option.
std::vector<double> numbers_of(const std::string& option, const std::string& text,
                               const Bounds& bounds);
// Seconds of "1/60" or "0.0167", and of "2ms", "500us" or "0.002s"; both throw UsageError.
double fraction_of(const std::string& option, const std::string& text);
double duration_of(const std::string& option, const std::string& text);
std::string suite_path(const SweepOptions& options);
Suite load_suite(const SweepOptions& options);
SweepFilters make_filters(const SweepOptions& options);
// Scenes of the plan without a reference: their points carry no trajectory error.
std::vector<std::pair<std::string, SceneParameters>> without_reference(
    const std::vector<Search>& searches, ReferenceShelf& shelf);

}  // namespace harness
