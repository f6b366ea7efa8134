// A suite: what a sweep runs. Read from JSON (configs/*.json, schema configs/suite.schema.json).
#pragma once

#include "harness/points/contestant.h"

namespace harness {

// Most steps of a run; more is a mistake in the step.
constexpr double most_steps = 1e8;

// A frame of film: no simulation makes longer steps, s.
constexpr double longest_step = 1.0 / 24;

struct SweepSpec {
  std::string sweep;  // "strain", "resolution" or "step"
  std::string scene;
  Contestants contestants = {};
  std::vector<double> limits;    // strain and step sweep: the axis; resolution sweep: one
  std::vector<int> resolutions;  // resolution sweep: the axis; the others: one
  // Unless they are given, the ladder begins at the run's whole duration at most.
  double coarsest = 1.0 / 25, finest = 1.0 / 25600;  // s, ends of the step ladder
  bool every_step = false;  // the whole ladder instead of a search; step sweeps always do
  bool refine = true;       // also try rungs between the halvings
  SceneParameters scene_parameters = {};
  std::map<std::string, Settings> solver_options = {};  // a contestant's own go first
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(SweepSpec, sweep, scene, limits, resolutions,
                                                scene_parameters, solver_options)

struct Suite {
  std::string name = "unnamed", description, profile = "custom";
  std::uint64_t seed = 1;
  int reps = 3;         // samples of each point that may be best, the first one included
  double timeout = 60;  // s a point
  // The tightest of answer_levels that the search for steps goes on for; above all of them: none.
  double finest_error = answer_levels.back();
  std::string same;  // the contestant that runs twice in every sweep; "": none
  // The file that the contestants' tuned settings are from, and a hash of what it says; "": none.
  std::string tuned_file, tuned_hash;
  std::vector<SweepSpec> sweeps;
  // A run is stopped once it takes this many times as long as the fastest one there. Infinite: never.
  double far_behind = 30;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Suite, name, description, profile, seed, reps,
                                                timeout, finest_error)

std::vector<std::string> sweep_kinds();
// Levels of error that best steps are searched for, loose to tight.
std::vector<double> levels_of(const Suite& suite);
// Contestants of all sweeps, each name once.
Contestants contestants_of(const Suite& suite);

// Throws UsageError, naming file, key and value, for anything that is not a suite. "tuned" and
// "same" have been applied to its contestants.
Suite read_suite(const std::string& path);
// The same of a text; `path` is for messages.
Suite parse_suite(const std::string& text, const std::string& path);
// Its two steps, for options that change the document in between: JSON that fits the schema, and
// what it says.
json suite_document(const std::string& text, const std::string& path);
Suite suite_of(const json& document, const std::string& path);
// parse_suite() reads it back.
json to_json(const Suite& suite);

}  // namespace harness
