// On what `bench tune` searches settings, and when a setting that it found is out of date.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "harness/points/suite.h"
#include "harness/points/tuned.h"

namespace harness {

// The scenes that settings are searched on, one a kind, each at two sizes and three limits. No
// reported result has these sizes. Without contestants.
const std::vector<SweepSpec>& tuning_scenes();

// Where a solver takes too long at one of a scene's sizes, it is tuned at the first of these that
// is smaller and does not take too long.
std::vector<int> smaller_sizes(const std::string& scene);

// All that a search depends on but for the programs that it times: the scene with all its
// parameters, sizes, limits, ladder and level of error, and the solver's settings with their
// defaults and ranges.
nlohmann::json tuning_rule(const SweepSpec& scene, const inextensible::Backend& solver);

// Whether an entry was found by today's rule.
bool up_to_date(const TunedEntry& entry);
// read_tuned(), and UsageError for the first entry that was not, which says what has changed.
Tuned read_tuned_up_to_date(const std::string& file);

}  // namespace harness
