// What claims and tables look at: points of result files, and curves of each contestant's best
// points.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/claims/claims.h"
#include "harness/claims/verdicts.h"

namespace harness::claims {

// A point of a result file, as far as claims need it; numbers that it lacks are not-a-number. The
// document must outlive it.
class Point {
 public:
  // noise: of the file's A/A pair, see ratio_of_medians.
  explicit Point(const nlohmann::json& document, double noise = std::nan(""))
      : p_(&document), noise_(noise) {}

  std::string id() const { return p_->at("id"); }
  std::string text(const char* key) const { return p_->at(key); }
  // Who competes: a solver with its settings. Older files have solvers only.
  std::string contestant() const { return p_->value("contestant", text("solver")); }
  bool is(const char* key, const std::string& value) const { return p_->at(key) == value; }
  bool flag(const char* key) const { return p_->value(key, false); }
  bool ok() const { return is("status", "ok"); }
  bool timed() const { return !p_->at("seconds_per_simulated_second").is_null(); }
  double number(const char* key) const { return figure(*p_, key); }
  double work(const char* key) const { return figure(p_->at("work"), key); }
  double error(const char* key) const { return figure(p_->at("error"), key); }
  double option(const char* key) const { return figure(p_->at("options"), key); }
  double scene_parameter(const char* key) const { return figure(p_->at("scene_parameters"), key); }
  bool solves_by(const std::string& linear_solver) const {
    return p_->at("options").value("linear_solver", "") == linear_solver;
  }
  const nlohmann::json& document() const { return *p_; }

  double seconds() const {  // not-a-number where nothing was timed
    return timed() ? p_->at("seconds_per_simulated_second").at("median").get<double>()
                   : std::nan("");
  }
  // Of the inextensibility filter alone; not-a-number in older files.
  double filter_seconds() const;
  std::vector<double> samples() const;
  double noise() const { return noise_; }
  double steps() const { return number("duration") / number("step"); }
  // The largest strain after the collision filter, which is what a user gets.
  double delivered_strain() const;
  // Whether its distance to the reference is known to be within a level: of the samples at which
  // the reference is sure enough for that level.
  bool within_error(double level) const;

 private:
  static double figure(const nlohmann::json& object, const char* key) {
    const auto place = object.find(key);
    return place == object.end() || !place->is_number() ? std::nan("") : place->get<double>();
  }
  const nlohmann::json* p_;
  double noise_;
};

// Of a's time over b's.
Ratio ratio(const Point& a, const Point& b);
// Of the time of a step.
Ratio ratio_of_steps(const Point& a, const Point& b);

// What a file says of who competes in it.
struct Role {
  std::string name, family;
  std::string solver;  // that it is, with settings of its own
  bool competes = true;
  bool hollow = false;  // shown beside its tuned self, not ranked
  bool again = false;   // the second of an A/A pair
  bool ranked() const { return competes && !hollow && !again; }
};

// Of one file's legend and noise; contestants that it does not name are their own family.
class Cast {
 public:
  Cast() = default;
  explicit Cast(const nlohmann::json& document);
  Role of(const std::string& contestant) const;
  // Whose row a contestant's points stand in where any settings may be chosen: a hollow one's in
  // its solver's, but for the second of an A/A pair, which would give the first a second chance.
  std::string at_any_settings(const std::string& contestant) const;
  void add(const Cast& other);  // what is known already stays

 private:
  std::map<std::string, Role> known_;
};

double pair_noise_of(const nlohmann::json& document);  // not-a-number: it has no A/A pair

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

  // The cell of a stability sweep; null if there is none.
  const nlohmann::json* cell(const std::string& hard_case, const std::string& solver) const;
  const std::vector<const nlohmann::json*>& matrix() const { return matrix_; }
  const std::vector<const nlohmann::json*>& freedom() const { return freedom_; }
  const std::vector<const nlohmann::json*>& same_frame() const { return same_frame_; }

  // Over the axis of a sweep ("strain" or "resolution"): one contestant's best points, with tuned
  // or untuned settings. One tuned setting serves all places of a scene; where the method's own
  // default is faster, that counts, so that tuning harms nobody.
  Curve best(const std::string& scene, const std::string& sweep,
             const std::string& contestant) const;
  // Over error levels: the fastest point within each, at any step and limit, with tuned or untuned
  // settings, of the largest size in step sweeps.
  Curve best_at_errors(const std::string& scene, const std::string& contestant) const;
  // Over vertices: the fastest point of the resolution sweep's within one level.
  Curve best_at_error(const std::string& scene, const std::string& contestant, double level) const;

  Role about(const std::string& contestant) const { return cast_.of(contestant); }
  // Those with points in a sweep of a scene that are ranked, in the files' order.
  std::vector<Role> ranked(const std::string& scene, const std::string& sweep) const;
  bool same_family(const std::string& a, const std::string& b) const {
    return cast_.of(a).family == cast_.of(b).family;
  }

 private:
  bool of(const Point& point, const std::string& scene, const std::string& sweep) const;

  std::vector<Point> all_;
  Cast cast_;
  std::map<std::pair<std::string, std::string>, double> largest_;  // vertices, by scene and sweep
  std::vector<const nlohmann::json*> matrix_, freedom_, same_frame_;
};

// Of seconds over the axis, both logarithmic.
Slope slope_of(const Curve& curve);
// Of a's seconds over b's, where both have a point: its interval is the wider one of what the
// scatter about the line and what the ratios' own intervals give.
Slope slope_of_ratio(const Curve& a, const Curve& b);
// Notes the curve's points as evidence.
void cite(ClaimVerdict& claim, const Curve& curve);
std::optional<Point> at(const Curve& curve, double x);

}  // namespace harness::claims
