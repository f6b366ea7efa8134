#include "harness/stability/merge_stability.h"

#include <algorithm>

#include "harness/base/errors.h"
#include "harness/base/shard.h"

namespace harness {
namespace {

using nlohmann::json;

Shard shard_of(const NamedResult& result) {
  return parse_shard(result.document.at("context").at("selection").at("shard"));
}

// Whether a known difference showed itself: null where its cell was not run.
void join_seen(json& list, const json& others) {
  for (std::size_t i = 0; i < list.size() && i < others.size(); ++i) {
    if (list.at(i).at("seen").is_null()) list.at(i)["seen"] = others.at(i).at("seen");
  }
}

}  // namespace

json merge_stability(std::vector<NamedResult> results, const MergeOptions& options) {
  for (const NamedResult& result : results) {
    if (!is_shard(result.document))
      throw UsageError("'" + result.name + "' is a whole stability sweep: only shards are joined");
  }
  check_alike(results, options);
  // Shards are stretches of the lists, so one after the other they are the lists again.
  std::stable_sort(results.begin(), results.end(), [](const NamedResult& a, const NamedResult& b) {
    return shard_of(a).index < shard_of(b).index;
  });
  for (std::size_t i = 1; i < results.size(); ++i) {
    if (shard_of(results[i - 1]).index == shard_of(results[i]).index)
      throw UsageError("'" + results[i - 1].name + "' and '" + results[i].name +
                       "' are the same shard");
  }
  const bool complete = check_shards(results, options);
  json joined = results.front().document;
  joined["context"] = joined_context(results);
  joined["complete"] = complete;
  for (std::size_t i = 1; i < results.size(); ++i) {
    const json& part = results[i].document;
    for (const char* list : {"matrix", "largest_steps", "degrees_of_freedom", "same_frame"})
      joined[list].insert(joined[list].end(), part.at(list).begin(), part.at(list).end());
    for (auto& [name, count] : joined["counts"].items())
      count = count.get<long>() + part.at("counts").at(name).get<long>();
    join_seen(joined["known_differences"], part.at("known_differences"));
  }
  return joined;
}

}  // namespace harness
