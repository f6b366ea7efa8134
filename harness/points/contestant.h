// A contestant of a sweep: a solver under a name, with settings of its own. One solver may take
// part several times.
#pragma once

#include "harness/base/text.h"
#include "harness/points/point_json.h"

namespace harness {

// Settings for scenes near this size and strain limit.
struct SettingsAt {
  int resolution = 1;
  double limit = 0.01;
  Settings settings;
  bool operator==(const SettingsAt&) const = default;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SettingsAt, resolution, limit, settings)

struct Contestant {
  std::string name;    // a-z, 0-9, _ and @; the solver's own unless it takes part more than once
  std::string solver;  // see `bench list solvers`
  Settings settings = {};  // given ones only
  std::string label = "";  // in figures; empty: the solver's, or the name in words
  bool unranked = false;   // beside the ranking, drawn with hollow marks
  // Further settings; those of the nearest place apply (by the ratios of sizes and limits).
  std::vector<SettingsAt> settings_at = {};

  Settings settings_for(int resolution, double limit) const;
  bool own_name() const { return name == solver; }
  bool operator==(const Contestant&) const = default;
};
using Contestants = std::vector<Contestant>;

// gauss_seidel of "gauss_seidel@bdf2": a method in a stepper; without @ in its published one.
inline std::string method_of(const std::string& name) { return name.substr(0, name.find('@')); }

// The contestant of this name, or the end.
Contestants::iterator find_contestant(Contestants& all, const std::string& name);
std::string label_of(const Contestant& contestant);

// A list of "icd", or {"name": "icd_loose", "solver": "icd", "settings": {...}, "label": "...",
// "unranked": true}, as in a suite that fits its schema. All throw UsageError, naming `where`.
Contestants read_contestants(const json& solvers, const std::string& where);
// The solvers of a suite that names none: all that compete and support every part of the scene. On
// a chain, a solver that coincides with another one there is left out.
Contestants competitors(const SceneType& type, const SceneParameters& given);
// What of the scene the solver does not take; "": nothing.
std::string not_taken(const Backend& solver, const SceneType& type, const SceneParameters& given);
// Throws unless the solver accepts them.
void check_settings(const Settings& settings, const std::string& where, const Backend& backend);
// Throws unless it consists of a-z, 0-9 and _, and one @ at most, for a method in a time stepper.
void check_plain_name(const std::string& name, const std::string& where);
const Backend& checked_backend(const std::string& name, const std::string& where);
// where: may be empty.
std::shared_ptr<const SceneType> checked_scene(const std::string& name,
                                               const std::string& where = "");
// Gives the reason for a pair that makes no sense, and a suggestion for any other name.
UsageError no_solver(const std::string& name, const std::vector<std::string>& known);
// Whether the pattern matches the name of this contestant or solver, with its published stepper
// appended or not.
bool matches(const Pattern& pattern, const std::string& solver);

// read_contestants() reads it back.
void to_json(json& to, const Contestant& contestant);

// Adds the same solver with the same settings right after it, as <name>_again: the difference
// between two equal contestants is the noise of a result. Does nothing if `name` is absent or its
// double is present.
void add_double(Contestants& all, const std::string& name);
std::string double_of(const std::string& name);

}  // namespace harness
