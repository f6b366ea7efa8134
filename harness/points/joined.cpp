#include "harness/points/joined.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "harness/base/errors.h"
#include "harness/base/shard.h"
#include "harness/points/result_file.h"

namespace harness {
namespace {

using nlohmann::json;
using Pointer = json::json_pointer;

// What a point's search for a best step has in common; of a hard case: case and solver.
std::string owner_of(const json& row) {
  json owner = json::array();
  for (const char* key : {"case", "sweep", "scene", "scene_parameters", "vertices", "contestant",
                          "solver", "strain_limit"})
    owner.push_back(row.value(key, json()));
  return owner.dump();
}

void add_rows(json& all, const json& more, const json& again, std::set<std::string>& taken) {
  std::set<std::string> here;
  for (const json& row : more) {
    if (!again.is_null() && row.value("contestant", json()) == again) continue;
    const std::string owner = owner_of(row);
    if (taken.contains(owner)) continue;
    here.insert(owner);
    all.push_back(row);
  }
  taken.merge(here);
}

// Entries whose name is new.
void add_named(json& all, const json& more) {
  for (const json& entry : more) {
    if (std::none_of(all.begin(), all.end(),
                     [&](const json& one) { return one.at("name") == entry.at("name"); }))
      all.push_back(entry);
  }
}

void add_stability(json& all, const json& more) {
  for (const char* list : {"largest_steps", "degrees_of_freedom", "same_frame"})
    all[list].insert(all[list].end(), more.at(list).begin(), more.at(list).end());
  for (auto& [name, count] : all["counts"].items())
    count = count.get<long>() + more.at("counts").at(name).get<long>();
  json& differences = all["known_differences"];
  const json& others = more.at("known_differences");
  for (std::size_t i = 0; i < std::min(differences.size(), others.size()); ++i) {
    if (differences[i].at("seen").is_null()) differences[i]["seen"] = others[i].at("seen");
  }
}

// Whether documents that are shards are all there.
bool all_shards(const std::vector<json>& documents) {
  std::set<std::size_t> found;
  std::size_t count = 0;
  for (const json& document : documents) {
    const std::string text = document.value(Pointer("/context/selection/shard"), std::string());
    if (text.empty()) continue;
    const Shard shard = parse_shard(text);
    count = shard.count;
    found.insert(shard.index);
  }
  return found.size() == count;
}

}  // namespace

json joined(const std::vector<json>& documents) {
  json all = documents.front();
  all["complete"] =
      all_shards(documents) && std::all_of(documents.begin(), documents.end(),
                                           [](const json& d) { return d.value("complete", true); });
  if (documents.size() == 1) return all;
  const bool sweep = all.contains("points");
  const char* rows = sweep ? "points" : "matrix";
  const Pointer q95("/context/noise/q95"), again("/context/noise/pair/1"),
      legend("/legend/solvers");
  all.erase("benchmarks");
  all[rows] = json::array();
  double noise = std::nan("");
  std::set<std::string> taken;
  for (const json& document : documents) {
    if (document.value("schema", "") != all.value("schema", ""))
      throw UsageError("results of different kinds of sweeps are no one table");
    add_rows(all[rows], document.at(rows), document.value(again, json()), taken);
    if (document.contains(legend)) add_named(all[legend], document.at(legend));
    if (document.contains("references")) add_named(all["references"], document.at("references"));
    if (const json own = document.value(q95, json()); own.is_number())
      noise = std::fmax(noise, own.get<double>());
    if (!is_timed(document)) all["context"]["timed"] = false;
    if (!sweep && &document != &documents.front()) add_stability(all, document);
  }
  if (std::isfinite(noise)) all[q95] = noise;
  if (all.contains(Pointer("/context/selection"))) all["context"]["selection"]["shard"] = "";
  return all;
}

json read_results(const std::vector<std::string>& paths) {
  std::vector<json> documents;
  documents.reserve(paths.size());
  for (const std::string& path : paths) documents.push_back(read_result(path));
  return joined(documents);
}

}  // namespace harness
