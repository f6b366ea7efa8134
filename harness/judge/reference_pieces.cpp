#include "harness/judge/reference_pieces.h"

#include <utility>

#include "harness/judge/reference_file.h"

namespace harness {

using inextensible::Positions;
using nlohmann::json;

namespace {

json path_json(const RouteRun& run) {
  json path = json::array();
  for (const Positions& x : run.path)
    path.push_back(std::vector<double>(x.data(), x.data() + x.size()));
  return path;
}

RouteRun run_of(const json& line) {
  RouteRun run;
  run.energy_drift = line.at("energy_drift").get<double>();
  for (const json& row : line.at("path")) {
    const auto numbers = row.get<std::vector<double>>();
    run.path.emplace_back(Eigen::Map<const Positions>(
        numbers.data(), 3, static_cast<Eigen::Index>(numbers.size() / 3)));
  }
  if (line.contains("shape")) run.shape = shape_series_of(line.at("shape"));
  return run;
}

}  // namespace

ReferencePieces::ReferencePieces(const std::string& out, const json& header) : journal_(out) {
  if (!journal_.damage().empty())
    news_.push_back(journal_.path() + ", " + journal_.damage() + ": what is damaged is run again");
  if (journal_.header() != header) {
    if (!journal_.known().empty())
      news_.emplace_back("runs of another build or --finest are dropped");
    journal_.start(header);
  } else if (!journal_.known().empty()) {
    news_.push_back("continues after " + std::to_string(journal_.known().size()) +
                    " runs that are done");
  }
}

const RouteRun& ReferencePieces::run(const std::string& name,
                                     const std::function<RouteRun()>& compute) {
  if (const auto known = known_.find(name); known != known_.end()) return known->second;
  if (const json* kept = journal_.find(name))
    return known_.emplace(name, run_of(*kept)).first->second;
  const RouteRun& run = known_.emplace(name, compute()).first->second;
  json value = {{"energy_drift", run.energy_drift}, {"path", path_json(run)}};
  if (!run.shape.empty()) value["shape"] = to_json(run.shape);
  journal_.add(name, std::move(value));
  return run;
}

}  // namespace harness
