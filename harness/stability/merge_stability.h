// Joins the shards of a stability sweep.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "harness/points/joining.h"

namespace harness {

// The whole sweep's result, as it would have been without shards. Throws UsageError as
// merge (harness/run/merge.h) does, and for what is no shard.
nlohmann::json merge_stability(std::vector<NamedResult> results, const MergeOptions& options);

}  // namespace harness
