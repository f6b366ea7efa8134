#include "harness/run/journaled.h"

#include <cmath>

#include "harness/points/point_json.h"

namespace harness {
namespace {

using nlohmann::json;

constexpr const char* repetition_mark = " #";

std::string key_of_repetition(const std::string& key, int i) {
  return key + repetition_mark + std::to_string(i);
}

bool is_point(const std::string& key) { return key.find(repetition_mark) == std::string::npos; }

void forget_point(const std::string& key, Journal& journal) {
  for (int i = 1; journal.find(key_of_repetition(key, i)); ++i)
    journal.forget(key_of_repetition(key, i));
  journal.forget(key);
}

// Leaves a point of a result file its first sample. Lists without an entry for each sample stay
// whole.
std::vector<Repetition> cut_off_repetitions(PointResult& point) {
  const std::size_t samples = point.samples.size();
  std::vector<Repetition> repetitions(samples > 1 ? samples - 1 : 0);
  const auto cut = [&](auto& list, auto Repetition::*member) {
    if (samples < 2 || list.size() != samples) return;
    for (std::size_t i = 1; i < samples; ++i) (repetitions[i - 1].*member).push_back(list[i]);
    list.resize(1);
  };
  cut(point.cpu_samples, &Repetition::cpu_samples);
  cut(point.filter_samples, &Repetition::filter_samples);
  cut(point.sample_runs, &Repetition::sample_runs);
  cut(point.samples, &Repetition::samples);
  return repetitions;
}

// A search for a stiffness goes another way from another start, where a neighbouring point failed
// then and does not now: its run is another one.
bool same_start(const PointResult& point, std::optional<double> guess) {
  if (!point.ok() || !point.stiffness) return true;
  return guess ? *guess == point.calibration_guess : std::isnan(point.calibration_guess);
}

}  // namespace

void add_runs_of(const json& result, Journal& journal) {
  for (const json& entry : result.at("points")) {
    PointResult point = point_of(entry);
    if (point.status == PointStatus::skipped) continue;
    point.best = false;  // to be decided again
    point.best_at_errors.clear();
    point.at_ladder_end.clear();
    const std::vector<Repetition> repetitions = cut_off_repetitions(point);
    const std::string key = key_of(point.spec);
    journal.add(key, to_json(point));
    for (std::size_t i = 0; i < repetitions.size(); ++i)
      journal.add(key_of_repetition(key, static_cast<int>(i) + 1), to_json(repetitions[i]));
  }
}

void forget_failures(Journal& journal) {
  std::vector<std::string> failed;
  for (const auto& [key, value] : journal.known()) {
    if (is_point(key) && value.at("status") != "ok") failed.push_back(key);
  }
  for (const std::string& key : failed) forget_point(key, journal);
}

std::size_t points_in(const Journal& journal) {
  std::size_t points = 0;
  for (const auto& [key, value] : journal.known()) points += is_point(key) ? 1 : 0;
  return points;
}

SweepRunners journaled(const SweepRunners& inner, Journal& journal) {
  SweepRunners runners;
  runners.references = inner.references;
  runners.run = [run = inner.run, &journal](const PointSpec& spec, const RunLimits& limits,
                                            std::optional<double> guess) {
    const std::string key = key_of(spec);
    if (const json* known = journal.find(key)) {
      PointResult point = point_of(*known);
      if (same_start(point, guess)) {
        if (limits.references)  // so that the result names it
          limits.references->find(spec.scene, spec.scene_parameters);
        return point;
      }
      forget_point(key, journal);
    }
    PointResult point = run(spec, limits, guess);
    journal.add(key, to_json(point));
    return point;
  };
  const auto repeated = std::make_shared<std::map<std::string, int>>();
  runners.repeat = [repeat = inner.repeat, repeated, &journal](PointResult& point,
                                                               const RunLimits& limits) {
    const std::string point_key = key_of(point.spec);
    const std::string key = key_of_repetition(point_key, ++(*repeated)[point_key]);
    if (const json* known = journal.find(key)) return append(repetition_of(*known), point);
    const Repetition before = samples_of(point);
    repeat(point, limits);
    journal.add(key, to_json(added_since(before, point)));
  };
  return runners;
}

}  // namespace harness
