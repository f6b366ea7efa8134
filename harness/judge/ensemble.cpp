#include "harness/judge/ensemble.h"

#include <algorithm>
#include <cmath>

namespace harness {

namespace {

struct Moments {
  double mean = 0, deviation = 0;
};

// Two passes: a spread that is small beside the mean keeps its digits.
Moments moments_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Moments found;
  for (const double value : values) found.mean += value / n;
  for (const double value : values) found.deviation += std::pow(value - found.mean, 2) / (n - 1);
  found.deviation = std::sqrt(found.deviation);
  return found;
}

}  // namespace

Ensemble ensemble_of(const std::vector<ShapeSeries>& runs) {
  Ensemble e;
  e.runs = static_cast<int>(runs.size());
  const std::size_t times = runs.front().size();
  std::vector<double> values(runs.size()), kinetic_sums(runs.size(), 0);
  for (std::size_t i = 0; i < times; ++i) {
    ShapeStatistics mean, deviation;
    for (const auto& [name, member] : shape_statistic_infos) {
      for (std::size_t k = 0; k < runs.size(); ++k) values[k] = runs[k][i].*member;
      const Moments found = moments_of(values);
      mean.*member = found.mean;
      deviation.*member = found.deviation;
    }
    e.mean.push_back(mean);
    e.deviation.push_back(deviation);
    for (std::size_t k = 0; k < runs.size(); ++k) {
      kinetic_sums[k] += runs[k][i].kinetic_energy;
      values[k] = kinetic_sums[k] / static_cast<double>(i + 1);
    }
    e.kinetic_deviation.push_back(moments_of(values).deviation);
  }
  return e;
}

ShapeError shape_error(const Ensemble& ensemble, const std::vector<double>& times,
                       const ShapeSeries& run) {
  ShapeError found;
  const std::size_t count = std::min(run.size(), ensemble.mean.size());
  if (count > 0) found.error = 0;
  double own = 0, mean = 0;
  for (std::size_t i = 0; i < count; ++i) {
    for (const auto& [name, member] : shape_statistic_infos) {
      const double off = std::abs(run[i].*member - ensemble.mean[i].*member);
      if (std::isnan(off)) return {};
      const double error = off - sure_deviations * ensemble.deviation[i].*member;
      if (error <= found.error) continue;
      found.error = error;
      found.statistic = name;
      found.time = times[i];
    }
    own += run[i].kinetic_energy;
    mean += ensemble.mean[i].kinetic_energy;
  }
  if (mean > 0) {
    found.kinetic_ratio = own / mean;
    found.kinetic_spread =
        sure_deviations * ensemble.kinetic_deviation[count - 1] * static_cast<double>(count) / mean;
  }
  return found;
}

bool kinetic_energy_lost(double ratio, double spread) {
  const bool far = ratio < least_kinetic_ratio || ratio > largest_kinetic_ratio;
  return far && std::abs(ratio - 1) > spread;
}

}  // namespace harness
