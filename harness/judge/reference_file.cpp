#include "harness/judge/reference_file.h"

#include <algorithm>
#include <cmath>

#include "harness/base/errors.h"
#include "harness/base/fields_json.h"
#include "harness/base/files.h"
#include "harness/base/json_reader.h"
#include "harness/base/text.h"
#include "harness/points/context.h"
#include "harness/points/measures.h"

namespace harness {

using inextensible::Positions;
using nlohmann::json;

namespace {

constexpr const char* reference_schema = "inextensible-reference/2";

double rounded(double value, double scale = 1e12) { return std::round(value * scale) / scale; }

json ensemble_json(const Ensemble& e) {
  json statistics = json::array();
  for (const auto& info : shape_statistic_infos) statistics.push_back(info.name);
  return {{"methods", e.methods},
          {"moved", e.moved},
          {"runs", e.runs},
          {"statistics", std::move(statistics)},
          {"mean", to_json(e.mean)},
          {"deviation", to_json(e.deviation)},
          {"kinetic_deviation", e.kinetic_deviation},
          {"unknown_because", e.unknown_because}};
}

Ensemble read_ensemble(const json& object) {
  Ensemble e;
  object.at("methods").get_to(e.methods);
  object.at("moved").get_to(e.moved);
  object.at("runs").get_to(e.runs);
  e.mean = shape_series_of(object.at("mean"));
  e.deviation = shape_series_of(object.at("deviation"));
  object.at("kinetic_deviation").get_to(e.kinetic_deviation);
  object.at("unknown_because").get_to(e.unknown_because);
  return e;
}

// Lists of the file that belong to its times.
bool lengths_agree(const Reference& r) {
  const std::size_t times = r.times.size();
  const Ensemble& e = r.ensemble;
  const bool ensemble = !e.known() || (e.mean.size() == times && e.deviation.size() == times &&
                                       e.kinetic_deviation.size() == times);
  return ensemble && r.gap.size() == times && r.gap_max.size() == times &&
         r.positions.size() <= times;
}

// That it is of a scene of ours, with as many vertices.
void check_mesh(const Reference& r, const std::string& path) {
  const auto type = find_scene(r.scene);
  if (!type) throw UsageError("'" + path + "': no scene '" + shortened(r.scene, 40) + "'");
  if (complete_parameters(*type, r.parameters) != r.parameters)
    throw UsageError("'" + path + "': 'scene_parameters' must hold every parameter of the scene");
  const int vertices = type->counts(r.parameters).first;
  for (const Positions& x : r.positions) {
    if (x.cols() != vertices)
      throw UsageError("'" + path + "': positions of " + std::to_string(x.cols()) +
                       " vertices, the scene has " + std::to_string(vertices));
  }
}

}  // namespace

json to_json(const ShapeSeries& series) {
  json rows = json::array();
  for (const ShapeStatistics& at : series) {
    json row = json::array();
    for (const auto& info : shape_statistic_infos) row.push_back(at.*info.member);
    rows.push_back(std::move(row));
  }
  return rows;
}

ShapeSeries shape_series_of(const json& rows) {
  ShapeSeries series;
  for (const json& row : rows) {
    ShapeStatistics at;
    for (std::size_t k = 0; k < shape_statistic_infos.size(); ++k)
      at.*shape_statistic_infos[k].member = row.at(k).get<double>();
    series.push_back(at);
  }
  return series;
}

std::string reference_name(const std::string& scene, const SceneParameters& complete) {
  const auto found_type = find_scene(scene);
  const SceneType& type = *found_type;
  std::string changed;
  for (const auto& info : type.parameters) {
    const std::string name = info.name;
    if (name == type.resolution || name == "duration") continue;
    if (complete.at(name) != info.initial)
      changed += name + "=" + number_text(complete.at(name)) + ";";
  }
  return scene + "-n" + number_text(complete.at(type.resolution)) +
         (changed.empty() ? "" : "-" + fnv1a(changed)) + ".json";
}

json to_json(const Reference& r) {
  json positions = json::array();
  // A file holds the digits that its gaps leave standing.
  const double least = r.gap.empty() ? 0 : *std::min_element(r.gap.begin(), r.gap.end());
  const double scale = least > 1e-7 ? 1e9 : 1e12;
  for (const Positions& x : r.positions) {
    json row = json::array();
    for (Eigen::Index i = 0; i < x.size(); ++i) row.push_back(rounded(x.data()[i], scale));
    positions.push_back(std::move(row));
  }
  json object = {{"schema", reference_schema},
                 {"scene", r.scene},
                 {"scene_parameters", r.parameters},
                 {"method", r.method},
                 {"second_method", r.second_method},
                 {"valid_until", r.valid_until},
                 {"energy_drift", r.energy_drift},
                 {"observed_order", number(r.observed_order)},
                 {"expected_order", r.expected_order},
                 {"times", r.times},
                 {"gap", r.gap},
                 {"gap_max", r.gap_max},
                 {"gap_parts", r.gap_parts},
                 {"positions", std::move(positions)}};
  if (r.ensemble.known() || !r.ensemble.unknown_because.empty())
    object["ensemble"] = ensemble_json(r.ensemble);
  return object;
}

json with_ensemble(json document, const Ensemble& ensemble) {
  document["ensemble"] = ensemble_json(ensemble);
  return document;
}

json summary_of(const Reference& r) {
  double squares = 0;
  for (std::size_t i = 0; i < r.positions.size(); ++i) squares += r.gap[i] * r.gap[i];
  const auto valid = static_cast<double>(std::max<std::size_t>(r.positions.size(), 1));
  return {{"name", r.name()},
          {"method", r.method},
          {"second_method", r.second_method},
          {"valid_until", r.valid_until},
          {"gap", std::sqrt(squares / valid)},
          {"observed_order", number(r.observed_order)},
          {"energy_drift", r.energy_drift}};
}

Reference read_reference(const std::string& path) {
  return reference_of(parse_document(read_file(path, "reference"), path), path);
}

Reference reference_of(const json& document, const std::string& path) {
  try {
    if (document.at("schema") != reference_schema)
      throw UsageError("'" + path + "': schema is " + value_text(document.at("schema")) +
                       ", must be \"" + reference_schema + "\"");
    Reference r;
    r.scene = document.at("scene").get<std::string>();
    r.parameters = document.at("scene_parameters").get<SceneParameters>();
    r.method = document.at("method").get<std::string>();
    r.second_method = document.at("second_method").get<std::string>();
    r.valid_until = document.at("valid_until").get<double>();
    r.energy_drift = document.at("energy_drift").get<double>();
    r.observed_order = number_of(document.at("observed_order"));
    r.expected_order = document.at("expected_order").get<double>();
    r.times = document.at("times").get<std::vector<double>>();
    r.gap = document.at("gap").get<std::vector<double>>();
    r.gap_max = document.at("gap_max").get<std::vector<double>>();
    r.gap_parts = document.value("gap_parts", r.gap_parts);
    if (document.contains("ensemble")) r.ensemble = read_ensemble(document.at("ensemble"));
    for (const json& row : document.at("positions")) {
      const auto numbers = row.get<std::vector<double>>();
      r.positions.emplace_back(Eigen::Map<const Positions>(
          numbers.data(), 3, static_cast<Eigen::Index>(numbers.size() / 3)));
    }
    check_mesh(r, path);
    if (!lengths_agree(r)) throw UsageError("'" + path + "': lists of different lengths");
    return r;
  } catch (const json::exception& error) {
    throw UsageError("'" + path + "' is not a reference: " + error.what());
  }
}

}  // namespace harness
