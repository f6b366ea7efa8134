// Joins result files of one suite: shards, or runs of different solvers.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "harness/points/joining.h"

namespace harness {

// One result file of all points, in the order in which the suite's sweep would have run them.
// Throws UsageError, naming the files, unless all are complete, of one suite and (but for
// mixed) of one machine and build, and no point is in two of them; and, but for partial, unless all
// shards of a sweep are there. Without one of them the result says that it is not complete.
nlohmann::json merge(const std::vector<NamedResult>& results, const MergeOptions& options);

}  // namespace harness
