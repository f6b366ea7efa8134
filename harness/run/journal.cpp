#include "harness/run/journal.h"

#include <cmath>

#include "harness/base/errors.h"
#include "harness/base/json_reader.h"
#include "harness/points/point_json.h"

namespace harness {
namespace {

using nlohmann::json;

constexpr const char* schema = "inextensible-journal/1";

void check_header(const json& line) {
  if (line.value("schema", "") != schema) throw UsageError("it is not a journal of this program");
  for (const char* key : {"identity", "context"})
    if (!line.at(key).is_object()) throw UsageError(std::string("no ") + key);
  if (!line.at("context").at("date").is_string()) throw UsageError("no date");
}

// One line of a journal into memory.
void learn_line(const json& line, Memory& memory) {
  if (line.contains("point")) {
    const PointResult point = point_of(line.at("point"));
    memory.points[key_of(point.spec)] = {point, {}};
  } else if (line.contains("repeat")) {
    memory.points.at(line.at("repeat").get<std::string>())
        .repetitions.push_back(repetition_of(line));
  } else {
    memory.points.erase(line.at("forget").get<std::string>());
  }
}

// Leaves a point of a result file its first sample. Lists without an entry for each sample stay
// whole.
std::deque<Repetition> cut_off_repetitions(PointResult& point) {
  const std::size_t samples = point.samples.size();
  std::deque<Repetition> repetitions(samples > 1 ? samples - 1 : 0);
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

}  // namespace

void Memory::learn(const json& result) {
  for (const json& entry : result.at("points")) {
    PointResult point = point_of(entry);
    if (point.status == PointStatus::skipped) continue;
    point.best = false;  // to be decided again
    point.best_at_errors.clear();
    point.at_ladder_end.clear();
    Known known;
    known.repetitions = cut_off_repetitions(point);
    known.point = std::move(point);
    points[key_of(known.point.spec)] = std::move(known);
  }
}

void Memory::forget_failures() {
  std::erase_if(points, [](const auto& entry) { return !entry.second.point.ok(); });
}

Journal::Journal(const std::string& out) : lines_(out) {
  lines_.read([this](const json& line, std::size_t number) {
    if (number == 1) {
      check_header(line);
      header_ = line;
    } else {
      learn_line(line, memory_);
    }
  });
}

void Journal::start(const json& header) {
  memory_ = {};
  header_ = header;
  header_["schema"] = schema;
  lines_.start(header_);
}

void Journal::add(const PointResult& point) { lines_.append({{"point", to_json(point)}}); }

void Journal::add_repetition(const std::string& key, const Repetition& repetition) {
  json line = to_json(repetition);
  line["repeat"] = key;
  lines_.append(line);
}

void Journal::forget(const std::string& key) { lines_.append({{"forget", key}}); }

namespace {

// A search for a stiffness goes another way from another start, where a neighbouring point failed
// then and does not now: its run is another one.
bool same_start(const PointResult& point, std::optional<double> guess) {
  if (!point.ok() || !point.stiffness) return true;
  return guess ? *guess == point.calibration_guess : std::isnan(point.calibration_guess);
}

}  // namespace

SweepRunners journaled(const SweepRunners& inner, Journal& journal, Memory memory) {
  const auto known = std::make_shared<Memory>(std::move(memory));
  SweepRunners runners;
  runners.references = inner.references;
  runners.run = [run = inner.run, known, &journal](const PointSpec& spec, const RunLimits& limits,
                                                   std::optional<double> guess) {
    const auto place = known->points.find(key_of(spec));
    if (place != known->points.end() && same_start(place->second.point, guess)) {
      if (limits.references)  // so that the result names it
        limits.references->find(spec.scene, spec.scene_parameters);
      return place->second.point;
    }
    PointResult point = run(spec, limits, guess);
    journal.add(point);
    return point;
  };
  runners.repeat = [repeat = inner.repeat, known, &journal](PointResult& point,
                                                            const RunLimits& limits) {
    const std::string key = key_of(point.spec);
    if (const auto place = known->points.find(key);
        place != known->points.end() && !place->second.repetitions.empty()) {
      append(place->second.repetitions.front(), point);
      place->second.repetitions.pop_front();
      return;
    }
    const Repetition before = samples_of(point);
    repeat(point, limits);
    journal.add_repetition(key, added_since(before, point));
  };
  return runners;
}

}  // namespace harness
