// Settings that `bench tune` found: for each solver at most one set a kind of scene. The file is
// configs/tuned.json, its schema configs/tuned.schema.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/points/contestant.h"

namespace harness {

// The time at one size and strain limit of a tuning scene, each at its best step of those tried.
struct TunedPlace {
  int resolution = 0;
  double limit = 0;
  double default_seconds = 0, default_step = 0;  // s/s, s
  // With the settings that were found; not-a-number where they fail.
  double seconds = 0, step = 0;
};

struct TunedEntry {
  std::string kind;  // of scene
  std::string solver;
  inextensible::Settings settings;  // those that are not the default
  // Geometric mean over the places of default_seconds over the smaller of both.
  double gain = 1;
  int evaluations = 0, budget = 0;  // sets of settings that were tried, and that might have been
  std::vector<TunedPlace> places;
  nlohmann::json rule;     // tuning_rule() of when it was found
  nlohmann::json context;  // date, commit and machine
};

struct Tuned {
  std::string file;  // its name
  std::string hash;  // of the settings alone
  std::vector<TunedEntry> entries;

  const TunedEntry* find(const std::string& kind, const std::string& solver) const;
};

// "tuned.json" is looked for in configs/, a path with a slash from where the program runs. Throws
// UsageError, naming file, key and value.
Tuned read_tuned(const std::string& file);
Tuned parse_tuned(const std::string& text, const std::string& file);

nlohmann::ordered_json tuned_document(const std::vector<TunedEntry>& entries);

// Which solvers stand there once more, hollow, without their tuned settings, as <name>_untuned:
// none, those that were faster without somewhere when they were tuned, or all that have any.
enum class Untuned { none, where_faster, all };

// Under its own name a solver gets its tuned settings, as far as neither its entry nor `given`
// says otherwise.
void tune(Contestants& all, const Tuned& tuned, const std::string& kind,
          const std::map<std::string, inextensible::Settings>& given, Untuned untuned);

}  // namespace harness
