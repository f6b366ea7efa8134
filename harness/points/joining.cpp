#include "harness/points/joining.h"

#include <map>
#include <set>

#include "harness/base/errors.h"
#include "harness/base/shard.h"
#include "harness/points/identity.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

using nlohmann::json;

std::string in_quotes(const std::string& name) { return "'" + name + "'"; }

// Which shards are not there, "2/3, 3/3", of those sweeps some of whose shards are.
std::string missing_shards(const std::vector<NamedResult>& results) {
  struct Cut {
    std::size_t count = 1;
    std::set<std::size_t> found;
  };
  std::map<std::string, Cut> cuts;  // by what else was selected, and into how many parts
  for (const NamedResult& result : results) {
    if (!is_shard(result.document)) continue;
    json selection = result.document.at("context").at("selection");
    const Shard part = parse_shard(selection.at("shard"));
    selection["shard"] = part.count;
    Cut& cut = cuts[selection.dump()];
    cut.count = part.count;
    cut.found.insert(part.index);
  }
  std::string missing;
  for (const auto& [selection, cut] : cuts) {
    for (std::size_t i = 1; i <= cut.count; ++i) {
      if (cut.found.contains(i)) continue;
      missing +=
          (missing.empty() ? "" : ", ") + std::to_string(i) + "/" + std::to_string(cut.count);
    }
  }
  return missing;
}

void check_pair(const NamedResult& first, const NamedResult& other, bool allow_mixed) {
  const auto same = [&](const json& was, const json& is, const std::string& what) {
    const std::string found = difference(was, is);
    if (!found.empty())
      throw UsageError(in_quotes(first.name) + " and " + in_quotes(other.name) +
                       " are of different " + what + ": " + found +
                       (what == "suites" ? "" : "; --allow-mixed joins them"));
  };
  const json &a = first.document.at("context"), &b = other.document.at("context");
  same(a.value("suite", json()), b.value("suite", json()), "suites");
  if (allow_mixed || a.at("fingerprint") == b.at("fingerprint")) return;
  same(identity(a, {}, {}), identity(b, {}, {}), "machines or builds");
}

}  // namespace

bool is_shard(const json& document) {
  return !document.value(json::json_pointer("/context/selection/shard"), std::string()).empty();
}

void check_alike(const std::vector<NamedResult>& results, const MergeOptions& options) {
  for (const NamedResult& result : results) {
    if (!result.document.at("complete").get<bool>())
      throw UsageError(in_quotes(result.name) + " is not complete; finish it with --resume first");
    check_pair(results.front(), result, options.mixed);
  }
}

bool check_shards(const std::vector<NamedResult>& results, const MergeOptions& options) {
  const std::string missing = missing_shards(results);
  if (!missing.empty() && !options.partial)
    throw UsageError("shard " + missing + " is missing; --partial joins the others all the same");
  return missing.empty();
}

json joined_context(const std::vector<NamedResult>& results) {
  json context = results.front().document.at("context");
  if (context.contains("selection")) context["selection"]["shard"] = "";
  const char* entries = results.front().document.contains("points") ? "points" : "matrix";
  json parts = json::array();
  bool noisy = false, timed = true;
  for (const auto& [name, document] : results) {
    const json& c = document.at("context");
    json part = {{"file", name}, {entries, document.at(entries).size()}};
    for (const char* key : {"date", "host_name", "fingerprint", "command", "load_avg", "sentinel",
                            "stolen", "harness_overhead", "retaken_samples"})
      if (c.contains(key)) part[key] = c.at(key);
    timed = timed && is_timed(document);
    noisy = noisy || (c.contains("sentinel") && c.at("sentinel").at("noisy").get<bool>());
    parts.push_back(std::move(part));
  }
  context["merged"] = parts;
  context["timed"] = timed;
  context["sentinel"] = {{"noisy", noisy}};  // each part has its own figures
  context.erase("stolen");
  context.erase("harness_overhead");
  context.erase("retaken_samples");
  return context;
}

}  // namespace harness
