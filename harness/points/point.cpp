#include "harness/points/point.h"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "harness/base/statistics.h"

namespace harness {

std::string PointSpec::id() const {
  std::ostringstream text;
  text << scene << '/' << name() << "/n:" << vertices << "/strain:" << strain_limit << "/h:";
  if (adaptive) {
    text << "adaptive";
  } else {
    text << step;
  }
  return text.str();
}

double median_uncertainty(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  const auto n = static_cast<unsigned>(samples.size());
  // The median lies below the k-th smallest sample with the chance of fewer than k heads in n
  // throws of a coin.
  unsigned k = 0;
  while (2 * (k + 1) <= n && gsl_cdf_binomial_P(k, 0.5, n) <= 0.025) ++k;
  if (k == 0) return std::numeric_limits<double>::infinity();
  return 0.5 * (samples[n - k] - samples[k - 1]) / quantile(samples, 0.5);
}

double trajectory_within(const Measures& measures, double target) {
  if (measures.error_series.empty())
    return sure_gaps * measures.gap > target ? unknown : measures.trajectory;
  double squares = 0;
  int count = 0;
  for (const ErrorSample& at : measures.error_series) {
    if (!(sure_gaps * at.gap <= target)) continue;
    squares += at.error * at.error;
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : unknown;
}

double error_known_until(const Measures& measures, double target) {
  if (measures.error_series.empty())
    return measures.trajectory >= 0 && sure_gaps * measures.gap <= target ? measures.valid_until
                                                                          : 0;
  double until = 0;
  for (const ErrorSample& at : measures.error_series)
    if (sure_gaps * at.gap <= target) until = std::max(until, at.time);
  return until;
}

double PointResult::median_seconds() const { return quantile(samples, 0.5); }
double PointResult::median_run() const { return median_seconds() * spec.step * steps_planned; }
double PointResult::median_filter_seconds() const { return quantile(filter_samples, 0.5); }
double PointResult::mean_step() const {
  if (!spec.adaptive || work.steps == 0) return spec.step;
  return spec.step * steps_planned / static_cast<double>(work.steps);
}

}  // namespace harness
