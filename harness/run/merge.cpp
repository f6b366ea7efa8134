#include "harness/run/merge.h"

#include <algorithm>
#include <map>

#include "harness/base/errors.h"
#include "harness/points/point_json.h"
#include "harness/points/result_file.h"
#include "harness/run/plan.h"

namespace harness {
namespace {

using nlohmann::json;

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

json merge(const std::vector<NamedResult>& results, const MergeOptions& options) {
  const Suite suite =
      parse_suite(results.front().document.at("context").at("suite").dump(), results.front().name);
  const auto place_of_search = places(suite);
  struct Placed {
    std::size_t search;
    PointResult point;
  };
  check_alike(results, options);
  std::vector<Placed> points;
  std::map<std::string, std::string> seen;  // the file that a point is in
  for (const NamedResult& result : results) {
    for (const json& entry : result.document.at("points")) {
      PointResult point = point_of(entry);
      const auto [place, fresh] = seen.emplace(key_of(point.spec), result.name);
      if (!fresh)
        throw UsageError("point " + point.spec.id() + " is in " + "'" + place->second +
                         "' and in '" + result.name + "'");
      PointSpec search = point.spec;
      search.step = 0;
      const auto found = place_of_search.find(key_of(search));
      points.push_back({found == place_of_search.end() ? place_of_search.size() : found->second,
                        std::move(point)});
    }
  }
  const bool complete = check_shards(results, options);
  std::stable_sort(points.begin(), points.end(),
                   [](const Placed& a, const Placed& b) { return a.search < b.search; });
  std::vector<PointResult> list;
  list.reserve(points.size());
  for (Placed& placed : points) list.push_back(std::move(placed.point));
  const json context = joined_context(results);
  return result_document(context, suite, context.at("command"), complete, list,
                         joined_references(results));
}

}  // namespace harness
