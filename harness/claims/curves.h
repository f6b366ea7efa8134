// What claims and tables look at: points of result files, and curves of each contestant's best
// points.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/analysis/measured_point.h"
#include "harness/claims/claims.h"
#include "harness/claims/verdicts.h"

namespace harness::claims {

using namespace analysis;  // claims speak of what was analysed

using Filter = std::function<bool(const Point&)>;
using Curve = std::map<double, Point>;  // by the value on the axis: a strain limit or vertices

// Errors over the scene's size that contests of least time are held at.
inline constexpr std::array error_levels{0.1, 0.03, 0.01, 0.003, 0.001, 0.0003, 0.0001};

// All points of some result files, which must outlive this. Points that two files have count once,
// those of runs with a step controller not at all.
class Points {
 public:
  explicit Points(const std::vector<nlohmann::json>& results);

  std::vector<Point> where(const Filter& wanted) const;
  bool repeated() const { return repeated_; }  // two files have a point

  // The cell of a stability sweep; null if there is none.
  const nlohmann::json* cell(const std::string& hard_case, const std::string& solver) const;
  const std::vector<const nlohmann::json*>& matrix() const { return matrix_; }
  const std::vector<const nlohmann::json*>& freedom() const { return freedom_; }
  const std::vector<const nlohmann::json*>& same_frame() const { return same_frame_; }

  // Over the axis of a sweep ("strain" or "resolution"): what one contestant answers within a level
  // of error (analysis/plane.h), with tuned or untuned settings. One tuned setting serves all
  // places of a scene; where the method's own default is faster, that counts, so that tuning harms
  // nobody.
  // vertices: of a strain sweep; none: the largest.
  Curve best(const std::string& scene, const std::string& sweep, const std::string& contestant,
             double level = any_motion, std::optional<double> vertices = {}) const;
  // Vertices of a scene's points in a sweep, large to small.
  std::vector<double> sizes(const std::string& scene, const std::string& sweep) const;
  // Over error levels: the fastest point within each, at any step and limit, with tuned or untuned
  // settings, of the largest size in step sweeps.
  Curve best_at_errors(const std::string& scene, const std::string& contestant) const;

  Role about(const std::string& contestant) const { return cast_.of(contestant); }
  // Those with points in a sweep of a scene that are ranked, in the files' order.
  std::vector<Role> ranked(const std::string& scene, const std::string& sweep,
                           std::optional<double> vertices = {}) const;
  bool same_family(const std::string& a, const std::string& b) const {
    return cast_.of(a).family == cast_.of(b).family;
  }

 private:
  bool of(const Point& point, const std::string& scene, const std::string& sweep,
          std::optional<double> vertices = {}) const;

  std::vector<Point> all_;
  bool repeated_ = false;
  ContestantRoles cast_;
  // Vertices, by scene and sweep.
  std::map<std::pair<std::string, std::string>, std::set<double, std::greater<>>> sizes_;
  std::vector<const nlohmann::json*> matrix_, freedom_, same_frame_;
};

// Slope of seconds over the axis, both logarithmic.
Slope slope_of(const Curve& curve);
// Ratio of a's seconds to b's, where both have a point: its interval is the wider one of what the
// scatter about the line and what the ratios' own intervals give.
Slope slope_of_ratio(const Curve& a, const Curve& b);
// Notes the curve's points as evidence.
void cite(ClaimVerdict& claim, const Curve& curve);
std::optional<Point> at(const Curve& curve, double x);

}  // namespace harness::claims
