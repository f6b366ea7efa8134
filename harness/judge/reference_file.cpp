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

constexpr const char* reference_schema = "inextensible-reference/1";

double rounded(double value, double scale = 1e12) { return std::round(value * scale) / scale; }

json shape_json(const std::vector<ShapeStatistics>& list) {
  json rows = json::array();
  for (const auto& s : list)
    rows.push_back({rounded(s.potential_energy), rounded(s.corner_height), rounded(s.shadow)});
  return rows;
}

std::vector<ShapeStatistics> shape_of(const json& rows) {
  std::vector<ShapeStatistics> list;
  for (const json& row : rows)
    list.push_back({row.at(0).get<double>(), row.at(1).get<double>(), row.at(2).get<double>()});
  return list;
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
  return {{"schema", reference_schema},
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
          {"shape", shape_json(r.shape)},
          {"shape_gap", shape_json(r.shape_gap)},
          {"positions", std::move(positions)}};
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
  const json document = parse_document(read_file(path, "reference"), path);
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
    r.expected_order = document.value("expected_order", expected_order(find_scene(r.scene).get()));
    r.times = document.at("times").get<std::vector<double>>();
    r.gap = document.at("gap").get<std::vector<double>>();
    // Older files know one norm: nothing in the other one is sure then.
    r.gap_max = document.value("gap_max", std::vector<double>(r.gap.size(), unknown));
    r.gap_parts = document.value("gap_parts", r.gap_parts);
    r.shape = shape_of(document.at("shape"));
    r.shape_gap = shape_of(document.at("shape_gap"));
    for (const json& row : document.at("positions")) {
      const auto numbers = row.get<std::vector<double>>();
      r.positions.emplace_back(Eigen::Map<const Positions>(
          numbers.data(), 3, static_cast<Eigen::Index>(numbers.size() / 3)));
    }
    check_mesh(r, path);
    if (r.gap.size() != r.times.size() || r.gap_max.size() != r.times.size() ||
        r.shape.size() != r.times.size() || r.shape_gap.size() != r.times.size() ||
        r.positions.size() > r.times.size())
      throw UsageError("'" + path + "': lists of different lengths");
    return r;
  } catch (const json::exception& error) {
    throw UsageError("'" + path + "' is not a reference: " + error.what());
  }
}

}  // namespace harness
