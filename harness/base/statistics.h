// Two samples of times compared without assumptions about how times are distributed.
#pragma once

#include <limits>
#include <span>
#include <vector>

namespace harness {

// The one-sided Mann-Whitney test (1947): how likely values of `a` are at least as far above those
// of `b` as they are, if both came from one distribution. Ties share their ranks. Exact, ties
// included, up to exact_up_to values in all; the normal approximation corrected for ties and
// continuity above. 1 if either is empty.
double mann_whitney_greater(const std::vector<double>& a, const std::vector<double>& b);
constexpr std::size_t exact_up_to = 60;

// The least value that mann_whitney_greater can have for that many values: 1 / (a + b over a).
double least_possible_p(std::size_t a, std::size_t b);

// Between order statistics linearly; 0.5: the median. Not-a-number for none.
double quantile(std::vector<double> samples, double fraction);

// The one time of a point: the least of its samples, which are all positive. Not-a-number for none.
// What disturbs a run makes it longer, never shorter, so that the least sample is nearest to the
// program's own time (Chen and Revels 2016, arXiv:1608.04295). It needs samples far longer than a
// read of the clock, hence batches (run/measure_point.cpp).
double time_of(const std::vector<double>& samples);

// A positive number with its 95 % confidence interval; nothing known: from 0 to infinity.
struct Ratio {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = 0, high = std::numeric_limits<double>::infinity();

  bool known() const { return low > 0 && high < std::numeric_limits<double>::infinity(); }
  bool above(double x) const { return low > x; }
  bool below(double x) const { return high < x; }
};

// time_of(a) over time_of(b). All values positive.
//
// The interval has two sources, and is the wider of the two on each side. (1) The samples: all
// factors between the two that the exact two-sided Mann-Whitney test does not reject (Hodges and
// Lehmann 1963; Hollander and Wolfe, Nonparametric Statistical Methods, 4.3), if times of the two
// are distributed alike up to a factor, which is then that of their least values, too. (A bootstrap
// of a minimum is not consistent: Bickel and Freedman 1981.) Three samples each cannot exclude
// anything at 95 %, four can. (2) noise: what 95 % of |log ratio|s stayed below that were measured
// of a program against itself (an A/A pair; not-a-number: there is none). It holds what no
// repetition shows: where code and data happened to lie, and what a machine does for minutes.
Ratio ratio_of_times(const std::vector<double>& a, const std::vector<double>& b,
                     double noise = std::numeric_limits<double>::quiet_NaN());

// The ratio of two times on another day, from ratios on two occasions or more. Logarithms of ratios
// are taken as normal, with a variance that varies from pair to pair: `scatter`^2 is what it is for
// pairs in general, and counts like prior_occasions further ones (an inverse gamma prior: Smyth
// 2004, Statistical Applications in Genetics 3:1). The interval is that of one further ratio
// (Student's t); it holds all ratios that were seen, and is no narrower than `noise` makes it.
// value: their geometric mean.
Ratio ratio_on_another_day(const std::vector<double>& ratios, double scatter,
                           double noise = std::numeric_limits<double>::quiet_NaN());
constexpr double prior_occasions = 4;

// Standard deviation of the logarithm of a ratio of two times between occasions. times: of each
// program by occasion; programs without all occasions do not count. What an occasion makes slower
// in all programs does not count either. Not-a-number for fewer than two programs or occasions.
double scatter_of(const std::vector<std::vector<double>>& times);

struct Slope {
  double value = std::numeric_limits<double>::quiet_NaN();
  // Half the 95 % confidence interval (Student's t); infinite for two points.
  double half_width = std::numeric_limits<double>::infinity();
  int points = 0;

  double low() const { return value - half_width; }
  double high() const { return value + half_width; }
};

// Least squares of log y over log x (GSL), of positive finite points. Fewer than two: not-a-number.
Slope log_log_slope(std::span<const double> x, std::span<const double> y);

}  // namespace harness
