// Settings that `bench tune` found: for each solver and kind of scene one set for each of some
// sizes and strain limits. The file is configs/tuned.json, its schema configs/tuned.schema.json.
#pragma once

#include "harness/points/suite.h"

namespace harness {

// What was found at one size and strain limit of a tuning scene. Times are of the best step tried.
struct TunedPlace : SettingsAt {                 // settings: those that are not the default
  int evaluations = 0;                           // sets of settings that were tried
  double default_seconds = 0, default_step = 0;  // s/s, s
  double seconds = 0, step = 0;                  // with the settings

  double gain() const { return default_seconds / seconds; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TunedPlace, resolution, limit, settings, evaluations,
                                   default_seconds, default_step, seconds, step)

struct TunedEntry {
  std::string kind;  // of scene
  std::string solver;
  int budget = 0;  // most sets of settings that were to be tried at a place
  std::vector<TunedPlace> places;
  json rule;     // tuning_rule() of when it was found
  json context;  // date, commit and machine

  std::vector<SettingsAt> settings_at() const;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TunedEntry, kind, solver, budget, places, rule, context)

struct Tuned {
  std::string file;  // its name
  std::string hash;  // of the settings alone
  std::vector<TunedEntry> entries;

  const TunedEntry* find(const std::string& kind, const std::string& solver) const;
};

// Throws UsageError, naming file, key and value.
Tuned parse_tuned(const std::string& text, const std::string& file);

json tuned_document(const std::vector<TunedEntry>& entries);

// Gives each solver under its own name its tuned settings, unless its entry or `given` overrides
// them.
void tune(Contestants& all, const Tuned& tuned, const std::string& kind,
          const std::map<std::string, Settings>& given = {});

// The scenes on which settings are searched for, one a kind, each at two sizes and three limits. No
// reported result has these sizes. Without contestants.
const std::vector<SweepSpec>& tuning_scenes();

// Where a solver takes too long at one of a scene's sizes, it is tuned at the first of these that
// is smaller and does not take too long.
std::vector<int> smaller_sizes(const std::string& scene);

// All that a search depends on except the programs that it times: the scene with its parameters,
// sizes, limits, ladder and level of error, and the solver's settings, their defaults and ranges.
json tuning_rule(const SweepSpec& scene, const Backend& solver);

// The command that searches again. file: of settings of one's own, or "".
std::string tune_command(const std::string& kind, const std::string& solver,
                         const std::string& file);

// The first difference between the rule that an entry was found by and today's; "": there is none.
std::string rule_change(const TunedEntry& entry);
// "tuned.json" is looked for in configs/, a path with a slash from where the program runs. Throws
// UsageError for the first entry whose rule has changed, too, and says how.
Tuned read_tuned_up_to_date(const std::string& file);

}  // namespace harness
