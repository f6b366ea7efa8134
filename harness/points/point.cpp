#include "harness/points/point.h"

#include "harness/base/statistics.h"
#include "harness/base/text.h"

namespace harness {

std::string PointSpec::id() const {
  return scene + '/' + contestant + "/n:" + std::to_string(vertices) +
         "/strain:" + number_text(strain_limit) + "/h:" + number_text(step);
}

ErrorAtLevel error_at(const Measures& measures, double level) {
  ErrorAtLevel at;
  if (measures.error_series.empty()) {
    if (!(measures.trajectory >= 0) || sure_gaps * measures.gap > level) return at;
    return {measures.trajectory, measures.trajectory_mean, measures.trajectory_max, measures.gap, 1,
            measures.valid_until};
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

bool within_error(const Measures& measures, double level) {
  return level == any_motion || error_at(measures, level).distance <= level;
}

bool within_known_error(const Measures& measures, double level) {
  return error_at(measures, level).samples == 0 || within_error(measures, level);
}

double PointResult::seconds() const { return time_of(samples); }
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

}  // namespace harness
