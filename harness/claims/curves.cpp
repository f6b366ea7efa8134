#include "harness/claims/curves.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "harness/base/text.h"

namespace harness::claims {

using nlohmann::json;

std::string text(double value, int digits) { return number_text(value, digits); }

std::string percent(double fraction) { return text(100 * fraction) + " %"; }

std::string text(const Slope& slope) {
  return text(slope.value, 2) +
         (std::isfinite(slope.half_width) ? " ± " + text(slope.half_width, 1) : "");
}

bool below(const Slope& a, const Slope& b) { return a.high() < b.low(); }

Points::Points(const std::vector<json>& results) {
  std::set<std::pair<std::string, std::string>> seen;  // id and sweep
  for (const json& result : results) {
    if (result.value("schema", "") == "inextensible-stability/1") {
      for (const json& cell : result.at("matrix")) matrix_.push_back(&cell);
      for (const json& mesh : result.at("degrees_of_freedom")) freedom_.push_back(&mesh);
      continue;
    }
    std::set<std::pair<std::string, std::string>> here;
    for (const json& p : result.at("points")) {
      const std::pair key(p.at("id").get<std::string>(), p.at("sweep").get<std::string>());
      if (seen.contains(key) || p.value("adaptive", false)) continue;
      // Claims are about solvers, each as it competes: under its own name.
      if (p.value("contestant", p.at("solver")) != p.at("solver")) continue;
      here.insert(key);
      all_.emplace_back(p);
    }
    seen.merge(here);
  }
  for (const Point& p : all_) {
    if (!p.is("sweep", "strain")) continue;
    double& largest = largest_[p.text("scene")];
    largest = std::max(largest, p.number("vertices"));
  }
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

Curve Points::best(const std::string& scene, const std::string& sweep,
                   const std::string& solver) const {
  const char* axis = sweep == "strain" ? "strain_limit" : "vertices";
  Curve curve;
  for (const Point& p : where([&](const Point& q) {
         return of(q, scene, sweep) && q.is("solver", solver) && q.flag("best") && q.ok();
       }))
    curve.try_emplace(p.number(axis), p);
  return curve;
}

// Strain sweeps of several sizes may come together: the largest counts.
bool Points::of(const Point& point, const std::string& scene, const std::string& sweep) const {
  if (!point.is("scene", scene) || !point.is("sweep", sweep)) return false;
  return sweep != "strain" || point.number("vertices") == largest_.at(scene);
}

Slope slope_of(const Curve& curve) {
  std::vector<double> x, y;
  for (const auto& [at, point] : curve) {
    x.push_back(at);
    y.push_back(point.seconds());
  }
  return log_log_slope(x, y);
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
