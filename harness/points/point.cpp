#include "harness/base/statistics.h"
#include "harness/base/text.h"
#include "harness/points/point_json.h"

namespace harness {

std::string PointSpec::id() const {
  std::string name;  // files go without their folders: that they differ is in their content's hash
  for (const char c : scene)
    c == '/' ? name.resize(name.find_last_of(":=;,") + 1) : name.push_back(c);
  return name + '/' + contestant + "/n:" + std::to_string(vertices) +
         "/strain:" + number_text(strain_limit) + "/h:" + number_text(step);
}

ErrorAtLevel error_at(const Measures& measures, double level) {
  ErrorAtLevel at{.level = level};
  if (measures.error_series.empty()) {
    for (const ErrorAtLevel& known : measures.error_levels)
      if (known.level >= level) at = known;  // loose to tight
    if (!measures.error_levels.empty() || !(measures.trajectory >= 0) ||
        sure_gaps * measures.gap > level)
      return at;
    return {
        level, measures.trajectory, measures.trajectory_mean, measures.trajectory_max, measures.gap,
        1,     measures.valid_until};
  }
  double sum = 0;
  const auto raise = [](double& largest, double value) {
    if (!(value <= largest)) largest = value;
  };
  for (const ErrorSample& sample : measures.error_series) {
    if (!(sure_gaps * sample.gap <= level)) continue;
    sum += sample.error;
    raise(at.distance, sample.error);
    raise(at.largest, sample.worst);
    raise(at.gap, sample.gap);
    ++at.samples;
    at.until = std::max(at.until, sample.time);
  }
  if (at.samples > 0) at.mean = sum / at.samples;
  return at;
}

std::vector<ErrorAtLevel> levels_of_series(const Measures& measures) {
  std::vector<ErrorAtLevel> levels;
  if (measures.error_series.empty()) return measures.error_levels;
  for (const double level : answer_levels) {
    const ErrorAtLevel at = error_at(measures, level);
    if (levels.empty() || levels.back().samples != at.samples) levels.push_back(at);
  }
  return levels;
}

bool within_error(const Measures& measures, double level) {
  return level == any_motion || error_at(measures, level).distance <= level;
}

bool within_known_error(const Measures& measures, double level) {
  return error_at(measures, level).samples == 0 || within_error(measures, level);
}

double PointResult::seconds() const { return time_of(samples); }
std::map<int, double> PointResult::times() const {
  std::map<int, double> times;
  if (!samples.empty()) times[0] = seconds();
  for (const OccasionTime& at : occasions) times[static_cast<int>(at.occasion)] = at.least;
  return times;
}
double PointResult::measured_seconds() const {
  double sum = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    sum += samples[i] * (i < sample_runs.size() ? sample_runs[i] : 1);
  return sum * spec.step * steps_planned;
}

void append(const Samples& more, PointResult& point) {
  const auto add = [&](auto Samples::*list) {
    (point.*list).insert((point.*list).end(), (more.*list).begin(), (more.*list).end());
  };
  add(&Samples::samples);
  add(&Samples::cpu_samples);
  add(&Samples::filter_samples);
  add(&Samples::sample_runs);
  point.retaken += more.retaken;
  if (!more.frame_times.empty()) point.frame_times = more.frame_times;
}

// ---- As JSON ----

namespace {

json seconds_json(const std::vector<double>& samples) {
  if (samples.empty()) return nullptr;
  return {{"median", quantile(samples, 0.5)},
          {"min", quantile(samples, 0)},
          {"q1", quantile(samples, 0.25)},
          {"q3", quantile(samples, 0.75)},
          {"samples", samples}};
}

}  // namespace

void to_json(json& to, PointStatus status) { to = to_string(status); }

void from_json(const json& from, PointStatus& status) {
  const auto row =
      std::ranges::find(point_statuses, from.get<std::string>(), &PointStatusInfo::name);
  if (row == point_statuses.end())
    throw json::other_error::create(501, from.dump() + " is not the status of a point", nullptr);
  status = row->status;
}

json to_json(const WorkCounters& work) {
  json object;
  for (const auto& counter : inextensible::work_counters)
    std::visit([&](const auto member) { object[counter.name] = work.*member; }, counter.member);
  return object;
}

WorkCounters work_of(const json& object) {
  WorkCounters work;
  for (const auto& counter : inextensible::work_counters)
    std::visit([&](const auto member) { object.at(counter.name).get_to(work.*member); },
               counter.member);
  return work;
}

json to_json(const Samples& samples) {
  json object;
  write_fields(object, sample_fields, samples);
  object["seconds_per_simulated_second"] = seconds_json(samples.samples);
  object["filter_seconds_per_simulated_second"] = seconds_json(samples.filter_samples);
  return object;
}

Samples samples_of(const json& object) {
  Samples samples;
  read_fields(object, sample_fields, samples);
  for (const auto& [key, list] :
       {std::pair("seconds_per_simulated_second", &samples.samples),
        std::pair("filter_seconds_per_simulated_second", &samples.filter_samples)})
    if (const json& seconds = object.at(key); !seconds.is_null())
      seconds.at("samples").get_to(*list);
  return samples;
}

json to_json(const PointResult& point) {
  json object = to_json(static_cast<const Samples&>(point));
  object["work"] = to_json(point.work);
  for_each_table(
      point, [&object](const auto& table, const auto& part) { write_fields(object, table, part); });
  json& options = object["options"] = object["settings"];
  if (point.stiffness) options["stiffness"] = *point.stiffness;
  if (!point.linear_solver.empty()) options["linear_solver"] = point.linear_solver;
  // For readers, from the others.
  object["id"] = point.spec.id();
  object["duration"] = point.spec.scene_parameters.at("duration");
  return object;
}

PointSpec spec_of(const json& object) {
  PointSpec spec;
  read_fields(object, spec_fields, spec);
  read_fields(object, size_fields, spec);
  if (!spec.scene_parameters.contains("duration"))
    throw json::other_error::create(503, "a point without duration", nullptr);
  if (spec.contestant.empty()) spec.contestant = spec.solver;
  return spec;
}

PointResult point_of(const json& object) {
  PointResult point(spec_of(object));
  static_cast<Samples&>(point) = samples_of(object);
  if (!(point.spec.step > 0)) throw json::other_error::create(504, "a point without step", nullptr);
  point.work = work_of(object.at("work"));
  read_fields(object, result_fields, point);
  read_fields(object, phase_fields, point.phases);
  read_fields(object, measure_fields, point.measures);
  const json& options = object.at("options");
  if (options.contains("stiffness") && !point.spec.settings.contains("stiffness"))
    point.stiffness = options.at("stiffness").get<double>();
  point.linear_solver = options.value("linear_solver", "");
  return point;
}

std::string key_of(const PointSpec& spec) {
  json key;
  write_fields(key, spec_fields, spec);
  return key.dump();
}

}  // namespace harness
