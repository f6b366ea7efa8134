// Joins result files of one suite: shards, or runs of different solvers.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/points/named_result.h"

namespace harness {

// One result file of all points, in the order in which the suite's sweep would have run them.
// Throws UsageError, naming the files, unless all are complete, of one suite and (but for
// allow_mixed) of one machine and build, and no point is in two of them.
nlohmann::json merge(const std::vector<NamedResult>& results, bool allow_mixed);

}  // namespace harness
