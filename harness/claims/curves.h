// What claims look at: points of result files, and curves of each solver's best points.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/base/fit.h"
#include "harness/claims/claims.h"

namespace harness::claims {

// Verdicts.
constexpr const char* reproduced = "reproduced";
constexpr const char* not_reproduced = "not reproduced";
constexpr const char* changed = "changed";
constexpr const char* not_measured = "not yet measured";

std::string text(double value, int digits = 3);
std::string percent(double fraction);  // "1.2 %"
std::string text(const Slope& slope);  // "-0.5 ± 0.1", with its 95 % interval

// Whether a's 95 % interval lies below b's.
bool below(const Slope& a, const Slope& b);

// A point of a result file, as far as claims need it; numbers that it lacks are not-a-number. The
// document must outlive it.
class Point {
 public:
  explicit Point(const nlohmann::json& document) : p_(&document) {}

  std::string id() const { return p_->at("id"); }
  std::string text(const char* key) const { return p_->at(key); }
  bool is(const char* key, const std::string& value) const { return p_->at(key) == value; }
  bool flag(const char* key) const { return p_->value(key, false); }
  bool ok() const { return is("status", "ok"); }
  double number(const char* key) const { return figure(*p_, key); }
  double work(const char* key) const { return figure(p_->at("work"), key); }
  double error(const char* key) const { return figure(p_->at("error"), key); }
  bool solves_by(const std::string& linear_solver) const {
    return p_->at("options").value("linear_solver", "") == linear_solver;
  }
  double option(const char* key) const { return figure(p_->at("options"), key); }
  double scene_parameter(const char* key) const { return figure(p_->at("scene_parameters"), key); }
  double seconds() const {
    const nlohmann::json& s = p_->at("seconds_per_simulated_second");
    return s.is_null() ? std::nan("") : s.at("median").get<double>();
  }
  double steps() const { return number("duration") / number("step"); }

 private:
  static double figure(const nlohmann::json& object, const char* key) {
    const auto place = object.find(key);
    return place == object.end() || !place->is_number() ? std::nan("") : place->get<double>();
  }
  const nlohmann::json* p_;
};

using Filter = std::function<bool(const Point&)>;
using Curve = std::map<double, Point>;  // by the value on the axis: a strain limit or vertices

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

  // Best points of one solver over the axis of a sweep ("strain" or "resolution").
  Curve best(const std::string& scene, const std::string& sweep, const std::string& solver) const;

 private:
  bool of(const Point& point, const std::string& scene, const std::string& sweep) const;

  std::vector<Point> all_;
  std::map<std::string, double> largest_;  // vertices in a scene's strain sweeps
  std::vector<const nlohmann::json*> matrix_, freedom_;
};

// Of seconds over the axis, both logarithmic.
Slope slope_of(const Curve& curve);
// Notes the curve's points as evidence.
void cite(ClaimVerdict& claim, const Curve& curve);
std::optional<Point> at(const Curve& curve, double x);

}  // namespace harness::claims
