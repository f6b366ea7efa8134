#include "harness/points/noise.h"

#include <cmath>
#include <map>

#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/points/contestant.h"
#include "harness/points/point_json.h"

namespace harness {
namespace {

using nlohmann::json;

// Where a point stands in a comparison: everything but its contestant and the step, which the best
// ones choose.
std::string place_of(const PointSpec& spec) {
  PointSpec place = spec;
  place.contestant = place.solver = "";
  place.settings.clear();
  if (spec.sweep != "step") place.step = 0;
  return key_of(place);
}

bool counts(const PointResult& point) {
  return point.ok() && (point.best || point.spec.sweep == "step");
}

}  // namespace

std::optional<PairNoise> pair_noise(const std::vector<PointResult>& points,
                                    const std::string& one) {
  PairNoise noise{one, double_of(one)};
  std::map<std::string, double> first;
  for (const PointResult& point : points) {
    if (counts(point) && point.spec.name() == noise.one)
      first[place_of(point.spec)] = point.seconds();
  }
  std::vector<double> distances;
  for (const PointResult& point : points) {
    if (!counts(point) || point.spec.name() != noise.other) continue;
    if (const auto twin = first.find(place_of(point.spec)); twin != first.end())
      distances.push_back(std::abs(std::log(point.seconds() / twin->second)));
  }
  if (distances.empty()) return {};
  noise.places = static_cast<int>(distances.size());
  noise.median = quantile(distances, 0.5);
  noise.q95 = quantile(distances, 0.95);
  return noise;
}

std::string noise_warning(const PairNoise& noise) {
  constexpr double most = 0.06;
  if (noise.q95 <= most) return {};
  return "noisy: equal programs differ by " + number_text(100 * std::expm1(noise.q95), 2) +
         " % here, more than the 6 % that a result to be quoted may have";
}

json to_json(const PairNoise& noise) {
  return {{"pair", {noise.one, noise.other}},
          {"places", noise.places},
          {"median", noise.median},
          {"q95", noise.q95}};
}

std::optional<PairNoise> noise_of(const json& context) {
  if (!context.contains("noise")) return {};
  const json& noise = context.at("noise");
  return PairNoise{noise.at("pair").at(0), noise.at("pair").at(1), noise.at("places"),
                   noise.at("median"), noise.at("q95")};
}

}  // namespace harness
