// What result files must share to be joined into one: a suite or a list of hard cases, a machine
// and a build, and all shards.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/points/named_result.h"

namespace harness {

struct MergeOptions {
  bool mixed = false, partial = false;
};

// Whether it is a part of a sweep (--shard).
bool is_shard(const nlohmann::json& document);

// All of these throw UsageError, naming the files.
// Unless all are complete, of one suite and (but for mixed) of one machine and build.
void check_alike(const std::vector<NamedResult>& results, const MergeOptions& options);
// Unless all shards of each sweep are there, or options.partial. Returns whether they are.
bool check_shards(const std::vector<NamedResult>& results, const MergeOptions& options);

// The first one's, with what each file has of its own: date, machine, load.
nlohmann::json joined_context(const std::vector<NamedResult>& results);

}  // namespace harness
