// A contestant of a sweep: a solver under a name, with settings of its own. One solver may stand
// there several times.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/base/errors.h"
#include "harness/base/pattern.h"
#include "harness/points/point_json.h"
#include "harness/scenes/scene.h"
#include "solvers/registry.h"

namespace harness {

// Settings for scenes of about this size and strain limit.
struct SettingsAt {
  int resolution = 1;
  double limit = 0.01;
  inextensible::Settings settings;
  bool operator==(const SettingsAt&) const = default;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SettingsAt, resolution, limit, settings)

struct Contestant {
  std::string name;    // a-z, 0-9, _ and @; the solver's own unless it stands there more than once
  std::string solver;  // see `bench list solvers`
  inextensible::Settings settings = {};  // given ones only
  std::string label = "";                // in figures; empty: the solver's, or the name in words
  bool unranked = false;                 // beside the ranking, drawn with hollow marks
  // Further settings, of which those of the nearest place hold (by the ratios of sizes and limits).
  std::vector<SettingsAt> settings_at = {};

  inextensible::Settings settings_for(int resolution, double limit) const;
  bool own_name() const { return name == solver; }
  bool operator==(const Contestant&) const = default;
};
using Contestants = std::vector<Contestant>;

// The place of one, or the end.
Contestants::iterator find_contestant(Contestants& all, const std::string& name);
std::string label_of(const Contestant& contestant);

// A list of "icd", or {"name": "icd_loose", "solver": "icd", "settings": {...}, "label": "...",
// "unranked": true}. All throw UsageError, naming `where`, key and value.
Contestants read_contestants(const nlohmann::json& solvers, const std::string& where);
// The solvers of suites that name none: all that compete and take every part of the scene, on a
// chain without those that are another one there.
Contestants competitors(const SceneType& type, const SceneParameters& given);
inextensible::Settings read_settings(const nlohmann::json& object, const std::string& where,
                                     const inextensible::Backend& backend);
// That the solver would take them.
void check_settings(const inextensible::Settings& settings, const std::string& where,
                    const inextensible::Backend& backend);
// That it is made of a-z, 0-9 and _, and one @ for a method in a time stepper.
void check_plain_name(const std::string& name, const std::string& where);
const inextensible::Backend& checked_backend(const std::string& name, const std::string& where);
// where: may be empty.
std::shared_ptr<const SceneType> checked_scene(const std::string& name,
                                               const std::string& where = "");
// A pair that makes no sense gets its reason, any other name a suggestion.
UsageError no_solver(const std::string& name, const std::vector<std::string>& known);
// Whether the pattern is of this contestant's or solver's name, that with its published stepper
// included.
bool matches(const Pattern& pattern, const std::string& solver);

// The way back.
void to_json(nlohmann::json& to, const Contestant& contestant);

// The same solver with the same settings once more, right after it, as <name>_again: how far two
// equal ones are apart is the noise of a result. Nothing if `name` does not stand there, or its
// double does.
void add_double(Contestants& all, const std::string& name);
std::string double_of(const std::string& name);

}  // namespace harness
