#include "harness/base/fit.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace harness {

Slope log_log_slope(std::span<const double> x, std::span<const double> y) {
  std::vector<double> log_x, log_y;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!(x[i] > 0) || !(y[i] > 0) || !std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    log_x.push_back(std::log(x[i]));
    log_y.push_back(std::log(y[i]));
  }
  Slope slope;
  slope.points = static_cast<int>(log_x.size());
  if (slope.points < 2) {
    slope.value = std::numeric_limits<double>::quiet_NaN();
    slope.half_width = std::numeric_limits<double>::infinity();
    return slope;
  }
  double intercept, cov00, cov01, cov11, squares;
  gsl_fit_linear(log_x.data(), 1, log_y.data(), 1, log_x.size(), &intercept, &slope.value, &cov00,
                 &cov01, &cov11, &squares);
  slope.half_width = slope.points > 2
                         ? std::sqrt(cov11) * gsl_cdf_tdist_Pinv(0.975, slope.points - 2)
                         : std::numeric_limits<double>::infinity();
  return slope;
}

}  // namespace harness
