#include "harness/run/merge.h"

#include <algorithm>
#include <map>
#include <set>

#include "harness/base/errors.h"
#include "harness/points/point_json.h"
#include "harness/points/result_file.h"
#include "harness/run/journal.h"

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

void check_alike(const NamedResult& first, const NamedResult& other, bool allow_mixed) {
  const auto same = [&](const json& was, const json& is, const std::string& what) {
    const std::string found = difference(was, is);
    if (!found.empty())
      throw UsageError(in_quotes(first.name) + " and " + in_quotes(other.name) +
                       " are of different " + what + ": " + found +
                       (what == "suites" ? "" : "; --allow-mixed joins them"));
  };
  const json &a = first.document.at("context"), &b = other.document.at("context");
  same(a.at("suite"), b.at("suite"), "suites");
  if (allow_mixed || a.at("fingerprint") == b.at("fingerprint")) return;
  same(identity(a, {}, {}), identity(b, {}, {}), "machines or builds");
}

// Where the suite's sweep comes to a search, by what distinguishes it.
std::map<std::string, std::size_t> places(const Suite& suite) {
  std::map<std::string, std::size_t> order;
  for (const Search& search : plan(suite, {})) {
    PointSpec spec = search.base;
    spec.step = 0;
    order.emplace(key_of(spec), order.size());
  }
  return order;
}

json joined_context(const std::vector<NamedResult>& results) {
  json context = results.front().document.at("context");
  if (context.contains("selection")) context["selection"]["shard"] = "";
  json parts = json::array();
  bool noisy = false, timed = true;
  for (const auto& [name, document] : results) {
    const json& c = document.at("context");
    json part = {{"file", name}, {"points", document.at("points").size()}};
    for (const char* key : {"date", "host_name", "fingerprint", "command", "load_avg", "sentinel",
                            "stolen", "harness_overhead"})
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
  return context;
}

json joined_references(const std::vector<NamedResult>& results) {
  std::map<std::string, json> by_name;
  for (const auto& result : results)
    for (const json& reference : result.document.at("references"))
      by_name.emplace(reference.at("name"), reference);
  json list = json::array();
  for (auto& [name, reference] : by_name) list.push_back(std::move(reference));
  return list;
}

}  // namespace

bool is_shard(const json& document) {
  return !document.value(json::json_pointer("/context/selection/shard"), std::string()).empty();
}

json merge(const std::vector<NamedResult>& results, const MergeOptions& options) {
  const Suite suite =
      parse_suite(results.front().document.at("context").at("suite").dump(), results.front().name);
  const auto place_of_search = places(suite);
  struct Placed {
    std::size_t search;
    PointResult point;
  };
  std::vector<Placed> points;
  std::map<std::string, std::string> seen;  // the file that a point is in
  for (const NamedResult& result : results) {
    if (!result.document.at("complete").get<bool>())
      throw UsageError(in_quotes(result.name) + " is not complete; finish it with --resume first");
    check_alike(results.front(), result, options.mixed);
    for (const json& entry : result.document.at("points")) {
      PointResult point = point_of(entry);
      const auto [place, fresh] = seen.emplace(key_of(point.spec), result.name);
      if (!fresh)
        throw UsageError("point " + point.spec.id() + " is in " + in_quotes(place->second) +
                         " and in " + in_quotes(result.name));
      PointSpec search = point.spec;
      search.step = 0;
      const auto found = place_of_search.find(key_of(search));
      points.push_back({found == place_of_search.end() ? place_of_search.size() : found->second,
                        std::move(point)});
    }
  }
  const std::string missing = missing_shards(results);
  if (!missing.empty() && !options.partial)
    throw UsageError("shard " + missing + " is missing; --partial joins the others all the same");
  std::stable_sort(points.begin(), points.end(),
                   [](const Placed& a, const Placed& b) { return a.search < b.search; });
  std::vector<PointResult> list;
  list.reserve(points.size());
  for (Placed& placed : points) list.push_back(std::move(placed.point));
  const json context = joined_context(results);
  return result_document(context, suite, context.at("command"), missing.empty(), list,
                         joined_references(results));
}

}  // namespace harness
