// Several result files as one table: shards of a sweep, a limit in each file, engines beside the
// built-in solvers.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace harness {

// documents: results of one kind (check_result), at least one. Points that belong to one search for
// a best step, or hard cases of one name, are taken from the first document that has any. The
// second contestant of an A/A pair is left out; the largest noise of all pairs stands for all. The
// rest of the context is the first one's. The table is complete if every document is, and all
// shards of a sweep that has shards are there. Throws UsageError for documents of different kinds.
nlohmann::json joined(const std::vector<nlohmann::json>& documents);

// The same of files; throws UsageError, naming the file, for what is no result.
nlohmann::json read_results(const std::vector<std::string>& paths);

}  // namespace harness
