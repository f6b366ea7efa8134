#include "harness/analysis/measured_point.h"

#include <algorithm>

namespace harness::analysis {

using nlohmann::json;

double Point::filter_seconds() const {
  return timed() ? time_of(samples_of("filter_seconds_per_simulated_second")) : std::nan("");
}

std::vector<double> Point::samples_of(const char* key) const {
  const auto seconds = p_->find(key);
  if (seconds == p_->end() || !seconds->is_object()) return {};
  return seconds->at("samples");
}

double Point::delivered_strain() const {
  for (const char* key : {"max_strain_after_collision", "max_strain"}) {
    if (const double strain = number(key); std::isfinite(strain)) return strain;
  }
  return std::nan("");
}

ErrorAtLevel Point::error_at(double level) const {
  Measures measures;
  measures.trajectory = error("trajectory");
  measures.trajectory_max = error("trajectory_max");
  measures.gap = error("gap");
  measures.valid_until = error("valid_until");
  const auto or_unknown = [](const json& value) {
    return value.is_number() ? value.get<double>() : unknown;
  };
  const auto series = p_->at("error").find("error_series");
  if (series != p_->at("error").end()) {
    for (const auto& sample : *series)  // time, error, largest, gap, its largest
      measures.error_series.push_back({or_unknown(sample.at(0)), or_unknown(sample.at(1)),
                                       or_unknown(sample.at(2)), or_unknown(sample.at(3)),
                                       or_unknown(sample.at(4))});
  }
  return harness::error_at(measures, level == any_motion ? headline_error : level);
}

bool Point::within_error(double level) const {
  return level == any_motion || error_at(level).distance <= level;
}

bool Point::marked_best(double level) const {
  if (level == any_motion) return flag("best");
  const auto levels = p_->find("best_at_errors");
  return levels != p_->end() &&
         std::find(levels->begin(), levels->end(), json(level)) != levels->end();
}

namespace {

Ratio times(Ratio ratio, double factor) {
  return {ratio.value * factor, ratio.low * factor, ratio.high * factor};
}

}  // namespace

Ratio ratio(const Point& a, const Point& b) {
  return ratio_of_times(a.samples(), b.samples(), std::fmax(a.noise(), b.noise()));
}

Ratio ratio_of_steps(const Point& a, const Point& b) {
  return times(ratio(a, b), a.number("step") / b.number("step"));
}

ContestantRoles::ContestantRoles(const json& document) {
  const json legend = document.value("legend", json::object());
  for (const char* list : {"contestants", "solvers"}) {
    for (const json& entry : legend.value(list, json::array())) {
      const std::string name = entry.at("name");
      known_.try_emplace(name, Role{.name = name,
                                    .family = entry.value("family", name),
                                    .solver = entry.value("solver", name),
                                    .competes = entry.value("contestant", true),
                                    .unranked = entry.value("unranked", false)});
    }
  }
  const json noise = document.value("context", json::object()).value("noise", json());
  if (noise.is_object() && noise.contains("pair")) {
    const json& pair = noise.at("pair");
    const std::string second = pair.is_array() ? pair.at(1) : pair;
    known_.try_emplace(second, Role{.name = second, .family = second, .solver = second});
    known_.at(second).again = true;
  }
}

Role ContestantRoles::of(const std::string& contestant) const {
  const auto place = known_.find(contestant);
  return place != known_.end()
             ? place->second
             : Role{.name = contestant, .family = contestant, .solver = contestant};
}

std::string ContestantRoles::at_any_settings(const std::string& contestant) const {
  const Role role = of(contestant);
  return role.unranked && !role.again ? role.solver : contestant;
}

void ContestantRoles::add(const ContestantRoles& other) {
  known_.insert(other.known_.begin(), other.known_.end());
}

double pair_noise_of(const json& document) {
  const json noise = document.value("context", json::object()).value("noise", json());
  return noise.is_object() && noise.contains("q95") && noise.at("q95").is_number()
             ? noise.at("q95").get<double>()
             : std::nan("");
}

}  // namespace harness::analysis
