#include "harness/claims/curves.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "harness/analysis/plane.h"

namespace harness::claims {

using nlohmann::json;

Points::Points(const std::vector<json>& results) {
  // Ids do not name the order of passes.
  using Key = std::tuple<std::string, std::string, std::string, bool>;
  std::set<Key> seen;
  for (const json& result : results) {
    cast_.add(ContestantRoles(result));
    if (result.value("schema", "") == "inextensible-stability/1") {
      for (const json& cell : result.at("matrix")) matrix_.push_back(&cell);
      for (const json& mesh : result.at("degrees_of_freedom")) freedom_.push_back(&mesh);
      if (const auto frames = result.find("same_frame"); frames != result.end()) {
        for (const json& frame : *frames) same_frame_.push_back(&frame);
      }
      continue;
    }
    std::set<Key> here;
    for (const json& p : result.at("points")) {
      const Point point(p, pair_noise_of(result));
      if (point.flag("adaptive")) continue;
      const Key key(point.id(), point.contestant(), point.text("sweep"), point.collides_last());
      repeated_ = repeated_ || seen.contains(key);
      if (seen.contains(key)) continue;
      here.insert(key);
      all_.push_back(point);
    }
    seen.merge(here);
  }
  for (const Point& p : all_)
    sizes_[{p.text("scene"), p.text("sweep")}].insert(p.number("vertices"));
}

std::vector<Point> Points::where(const Filter& wanted) const {
  std::vector<Point> chosen;
  std::copy_if(all_.begin(), all_.end(), std::back_inserter(chosen), wanted);
  return chosen;
}

const json* Points::cell(const std::string& hard_case, const std::string& solver) const {
  const auto place = std::find_if(matrix_.begin(), matrix_.end(), [&](const json* c) {
    return c->at("case") == hard_case && c->at("solver") == solver;
  });
  return place == matrix_.end() ? nullptr : *place;
}

namespace {

void keep_faster(Curve& curve, double x, const Point& point) {
  const auto [place, added] = curve.try_emplace(x, point);
  if (!added && point.seconds() < place->second.seconds()) place->second = point;
}

}  // namespace

Curve Points::best(const std::string& scene, const std::string& sweep,
                   const std::string& contestant, double level,
                   std::optional<double> vertices) const {
  const char* axis = sweep == "strain" ? "strain_limit" : "vertices";
  std::map<std::pair<double, std::string>, std::vector<const Point*>> places;
  for (const Point& p : all_) {
    if (of(p, scene, sweep, vertices) && cast_.at_any_settings(p.contestant()) == contestant)
      places[{p.number(axis), p.contestant()}].push_back(&p);
  }
  Curve curve;
  for (const auto& [place, points] : places) {
    if (const Point* answer = fastest_of(points, level)) keep_faster(curve, place.first, *answer);
  }
  return curve;
}

Curve Points::best_at_errors(const std::string& scene, const std::string& contestant) const {
  Curve curve;
  for (const Point& p : where([&](const Point& q) {
         return of(q, scene, "step") && cast_.at_any_settings(q.contestant()) == contestant &&
                q.ok() && q.timed();
       })) {
    for (const double level : error_levels) {
      if (p.within_error(level)) keep_faster(curve, level, p);
    }
  }
  return curve;
}

std::vector<Role> Points::ranked(const std::string& scene, const std::string& sweep,
                                 std::optional<double> vertices) const {
  std::vector<Role> all;
  std::set<std::string> seen;
  for (const Point& p : where([&](const Point& q) { return of(q, scene, sweep, vertices); })) {
    if (!seen.insert(p.contestant()).second) continue;
    if (const Role one = about(p.contestant()); one.ranked()) all.push_back(one);
  }
  return all;
}

std::vector<double> Points::sizes(const std::string& scene, const std::string& sweep) const {
  const auto known = sizes_.find({scene, sweep});
  if (known == sizes_.end()) return {};
  return {known->second.begin(), known->second.end()};
}

// Strain and step sweeps of several sizes may come together: unless one is named, the largest
// counts.
bool Points::of(const Point& point, const std::string& scene, const std::string& sweep,
                std::optional<double> vertices) const {
  if (!point.is("scene", scene) || !point.is("sweep", sweep)) return false;
  return sweep == "resolution" ||
         point.number("vertices") == vertices.value_or(*sizes_.at({scene, sweep}).begin());
}

Slope slope_of(const Curve& curve) {
  std::vector<double> x, y;
  for (const auto& [at, point] : curve) {
    x.push_back(at);
    y.push_back(point.seconds());
  }
  return log_log_slope(x, y);
}

Slope slope_of_ratio(const Curve& a, const Curve& b) {
  std::vector<double> x, y, half_widths;
  for (const auto& [place, point] : a) {
    const auto other = at(b, place);
    if (!other) continue;
    const Ratio over = ratio(point, *other);
    x.push_back(place);
    y.push_back(over.value);
    half_widths.push_back(over.known() ? 0.5 * std::log(over.high / over.low) : 0);
  }
  Slope slope = log_log_slope(x, y);
  double mean = 0, squares = 0, spread = 0;
  for (const double at : x) mean += std::log(at) / static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double distance = std::log(x[i]) - mean;
    squares += distance * distance;
    spread += distance * distance * half_widths[i] * half_widths[i];
  }
  if (squares > 0) slope.half_width = std::max(slope.half_width, std::sqrt(spread) / squares);
  return slope;
}

void cite(ClaimVerdict& claim, const Curve& curve) {
  for (const auto& [at, point] : curve) claim.points.push_back(point.id());
}

std::optional<Point> at(const Curve& curve, double x) {
  for (const auto& [key, point] : curve) {
    if (std::abs(key / x - 1) < 1e-9) return point;
  }
  return {};
}

}  // namespace harness::claims
