// Fitted slopes with their uncertainty.
#pragma once

#include <span>

namespace harness {

struct Slope {
  double value = 0;
  double half_width = 0;  // of the 95 % confidence interval (Student's t); infinite for two points
  int points = 0;

  double low() const { return value - half_width; }
  double high() const { return value + half_width; }
};

// Least squares of log y over log x (GSL). Points that are not positive and finite are left out;
// fewer than two give a slope of not-a-number.
Slope log_log_slope(std::span<const double> x, std::span<const double> y);

}  // namespace harness
