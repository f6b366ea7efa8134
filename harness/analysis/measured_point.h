// What analysis looks at: the points of a result file, and its contestants.
#pragma once

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/base/statistics.h"
#include "harness/points/measures.h"

namespace harness::analysis {

// A point of a result file, as far as analysis needs it; numbers that it lacks are not-a-number.
// The document must outlive it.
class Point {
 public:
  // noise: of the file's A/A pair, see ratio_of_times.
  explicit Point(const nlohmann::json& document, double noise = std::nan(""))
      : p_(&document), noise_(noise) {}

  std::string id() const { return p_->at("id"); }
  std::string text(const char* key) const { return p_->at(key); }
  std::string contestant() const { return p_->at("contestant"); }  // a solver with its settings
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

  double seconds() const { return time_of(samples()); }  // not-a-number where nothing was timed
  // Time of the inextensibility filter alone.
  double filter_seconds() const;
  std::vector<double> samples() const { return samples_of("seconds_per_simulated_second"); }
  double noise() const { return noise_; }
  double steps() const { return number("duration") / number("step"); }
  // The largest strain after the collision filter, which is what a user gets.
  double delivered_strain() const;
  // The paper's order: the obstacle pushes vertices out after the solve (contact 0).
  bool collides_last() const { return scene_parameter("contact") == 0; }
  // Its distance to the reference at a level (points/measures.h); any_motion: at the headline's.
  ErrorAtLevel error_at(double level) const;
  // Whether that is known to be within the level; any_motion: always.
  bool within_error(double level) const;
  // Whether it is marked as its contestant's fastest within a level.
  bool marked_best(double level) const;

 private:
  std::vector<double> samples_of(const char* key) const;
  static double figure(const nlohmann::json& object, const char* key) {
    const auto place = object.find(key);
    return place == object.end() || !place->is_number() ? std::nan("") : place->get<double>();
  }
  const nlohmann::json* p_;
  double noise_;
};

// Ratio of a's time to b's.
Ratio ratio(const Point& a, const Point& b);
// Ratio of the times of a step.
Ratio ratio_of_steps(const Point& a, const Point& b);

// What a file says of a contestant.
struct Role {
  std::string name, family;
  std::string solver;  // that it is, with settings of its own
  bool competes = true;
  bool unranked = false;  // shown beside its tuned self, not ranked
  bool again = false;     // the second of an A/A pair
  bool ranked() const { return competes && !unranked && !again; }
};

// One file's legend and noise; contestants that it does not name are their own family.
class ContestantRoles {
 public:
  ContestantRoles() = default;
  explicit ContestantRoles(const nlohmann::json& document);
  Role of(const std::string& contestant) const;
  // Whose row a contestant's points stand in where any settings may be chosen: an unranked one's in
  // its solver's, but for the second of an A/A pair, which would give the first a second chance.
  std::string at_any_settings(const std::string& contestant) const;
  void add(const ContestantRoles& other);  // what is known already stays

 private:
  std::map<std::string, Role> known_;
};

double pair_noise_of(const nlohmann::json& document);  // not-a-number: it has no A/A pair

}  // namespace harness::analysis
