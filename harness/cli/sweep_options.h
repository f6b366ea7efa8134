// The options that select what a sweep runs, shared by several verbs.
#pragma once

#include <string>
#include <vector>

#include "harness/cli/shared_options.h"
#include "harness/run/sweep.h"

namespace harness {

struct SweepOptions : SceneOptions {  // n: instead of the suite's
  std::string sweep, solver, filter, exclude, config, profile = "default", steps = "search";
  std::string reps;    // "5", or "5..40" with rel_ci
  std::string limits;  // numbers between commas, instead of the suite's
  double timeout = 0, finest_error = 0, rel_ci = 0, finest = 0;
  std::int64_t seed = -1;
  bool untimed = false;  // times are not used: does not wait for others that take times
};

// --sweep, the scene's, --profile and --config.
void add_scene_selection(const Command& to, SweepOptions& options);
// These, --limit, --solver, --filter and --exclude.
void add_selection(const Command& to, SweepOptions& options);

// --reps, --rel-ci, --timeout, --steps, --finest, --finest-error, --seed and --untimed.
void add_measurement(const Command& to, SweepOptions& options);

// All of these throw UsageError.
std::string suite_path(const SweepOptions& options);
Suite load_suite(const SweepOptions& options);
SweepFilters make_filters(const SweepOptions& options);
// Scenes of the plan without a reference: their points carry no trajectory error.
std::vector<std::pair<std::string, SceneParameters>> without_reference(
    const std::vector<Search>& searches, ReferenceFolder& references);

}  // namespace harness
