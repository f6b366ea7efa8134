#include "harness/base/statistics.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_statistics.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace harness {
namespace {

struct Ranking {
  std::vector<int> doubled;  // ranks of all values, a's first, times two: ties make halves
  double ties = 0;           // sum of t^3 - t over groups of t equal values
};

Ranking rank_all(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> all = a;
  all.insert(all.end(), b.begin(), b.end());
  Ranking ranking;
  ranking.doubled.reserve(all.size());
  for (const double x : all) {
    const auto less = std::ranges::count_if(all, [x](double y) { return y < x; }),
               equal = std::ranges::count(all, x);
    ranking.doubled.push_back(static_cast<int>(2 * less + equal + 1));  // twice the mean rank
    ranking.ties += static_cast<double>(equal * equal - 1);
  }
  return ranking;
}

// [s]: in how many ways n of these ranks add up to s; at most (60 over 30) = 1.2e17.
std::vector<double> ways_to_sum(const std::vector<int>& ranks, std::size_t n) {
  const std::size_t sums = std::accumulate(ranks.begin(), ranks.end(), 1);
  // ways[k][s]: choices of k of the ranks seen so far with sum s.
  std::vector<std::vector<double>> ways(n + 1, std::vector<double>(sums, 0.0));
  ways[0][0] = 1;
  for (const int rank : ranks) {
    const std::size_t r = rank;
    for (std::size_t k = n; k > 0; --k)
      for (std::size_t s = sums - 1; s >= r; --s) ways[k][s] += ways[k - 1][s - r];
  }
  return ways[n];
}

// Standard deviation of U, the number of pairs whose first member is larger, for one distribution.
double normal_spread(double n1, double n2, double ties) {
  const double n = n1 + n2;
  return std::sqrt(n1 * n2 / 12 * (n + 1 - ties / (n * (n - 1))));
}

// The largest c such that U < c has a probability of at most 2.5 % in one distribution, or 0.
std::size_t critical_count(std::size_t n1, std::size_t n2) {
  if (n1 + n2 > exact_up_to) {
    const auto a = static_cast<double>(n1), b = static_cast<double>(n2);
    const double c = a * b / 2 - gsl_cdf_ugaussian_Pinv(0.975) * normal_spread(a, b, 0);
    return c > 0 ? static_cast<std::size_t>(c) : 0;
  }
  std::vector<int> ranks(n1 + n2);
  std::iota(ranks.begin(), ranks.end(), 1);
  const std::vector<double> ways = ways_to_sum(ranks, n1);
  const double all = std::accumulate(ways.begin(), ways.end(), 0.0);
  const std::size_t least_sum = n1 * (n1 + 1) / 2;  // U is the sum of ranks less this
  std::size_t c = 0;
  for (double below = ways[least_sum] / all; below <= 0.025 && c < n1 * n2;)
    below += ways[least_sum + ++c] / all;
  return c;
}

}  // namespace

double mann_whitney_greater(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.empty() || b.empty()) return 1;
  const Ranking ranking = rank_all(a, b);
  const auto& ranks = ranking.doubled;
  const int sum =
      std::accumulate(ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(a.size()), 0);
  if (a.size() + b.size() <= exact_up_to) {
    const std::vector<double> ways = ways_to_sum(ranks, a.size());
    return std::accumulate(ways.begin() + sum, ways.end(), 0.0) /
           std::accumulate(ways.begin(), ways.end(), 0.0);
  }
  const auto n1 = static_cast<double>(a.size()), n2 = static_cast<double>(b.size());
  const double u = sum / 2.0 - n1 * (n1 + 1) / 2, spread = normal_spread(n1, n2, ranking.ties);
  return spread > 0 ? gsl_cdf_ugaussian_Q((u - n1 * n2 / 2 - 0.5) / spread) : 1;  // 1: all equal
}

double least_possible_p(std::size_t a, std::size_t b) {
  double choices = 1;  // not by logarithms: 1/20 must not come out below 0.05
  for (std::size_t i = 1; i <= a; ++i)
    choices = choices * static_cast<double>(b + i) / static_cast<double>(i);
  return 1 / choices;
}

double quantile(std::vector<double> samples, double fraction) {
  if (samples.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(samples.begin(), samples.end());
  return gsl_stats_quantile_from_sorted_data(samples.data(), 1, samples.size(), fraction);
}

double time_of(const std::vector<double>& samples) { return quantile(samples, 0); }

Ratio ratio_of_times(const std::vector<double>& a, const std::vector<double>& b, double noise) {
  if (a.empty() || b.empty()) return {};
  Ratio ratio;
  ratio.value = time_of(a) / time_of(b);
  if (const std::size_t c = critical_count(a.size(), b.size()); c > 0) {
    std::vector<double> quotients;
    quotients.reserve(a.size() * b.size());
    for (const double x : a)
      for (const double y : b) quotients.push_back(x / y);
    std::sort(quotients.begin(), quotients.end());
    // With skewed samples the quotient of minima may lie outside the test's interval.
    ratio.low = std::min(quotients[c - 1], ratio.value);
    ratio.high = std::max(quotients[quotients.size() - c], ratio.value);
  }
  if (std::isfinite(noise)) {
    const double low = ratio.value * std::exp(-noise), high = ratio.value * std::exp(noise);
    ratio.low = ratio.known() ? std::min(ratio.low, low) : low;
    ratio.high = std::isfinite(ratio.high) ? std::max(ratio.high, high) : high;
  }
  return ratio;
}

Ratio ratio_on_another_day(const std::vector<double>& ratios, double scatter, double noise) {
  const auto n = static_cast<double>(ratios.size());
  Ratio ratio;
  if (n < 2) return ratio;
  double mean = 0, squares = 0;
  for (const double r : ratios) mean += std::log(r) / n;
  for (const double r : ratios) squares += std::pow(std::log(r) - mean, 2);
  const double freedom = n - 1 + prior_occasions;
  const double spread = std::sqrt((squares + prior_occasions * scatter * scatter) / freedom);
  double half = gsl_cdf_tdist_Pinv(0.975, freedom) * spread * std::sqrt(1 + 1 / n);
  if (noise > half) half = noise;
  const auto [least, most] = std::ranges::minmax(ratios);
  return {std::exp(mean), std::min(least, std::exp(mean - half)),
          std::max(most, std::exp(mean + half))};
}

double scatter_of(const std::vector<std::vector<double>>& times) {
  std::size_t occasions = 0;
  for (const auto& own : times) occasions = std::max(occasions, own.size());
  std::vector<double> by_occasion(occasions, 0.0);
  std::vector<std::vector<double>> rest;  // logarithms, less the program's own mean
  for (const auto& own : times) {
    if (own.size() < occasions) continue;
    std::vector<double>& logs = rest.emplace_back();
    double mean = 0;
    for (const double t : own) mean += std::log(t) / static_cast<double>(occasions);
    for (const double t : own) logs.push_back(std::log(t) - mean);
    for (std::size_t k = 0; k < occasions; ++k) by_occasion[k] += logs[k];
  }
  if (rest.size() < 2 || occasions < 2) return std::numeric_limits<double>::quiet_NaN();
  const auto programs = static_cast<double>(rest.size());
  double squares = 0;
  for (const auto& logs : rest)
    for (std::size_t k = 0; k < occasions; ++k)
      squares += std::pow(logs[k] - by_occasion[k] / programs, 2);
  // The squares are those of single times; a ratio has two.
  return std::sqrt(2 * squares / ((programs - 1) * static_cast<double>(occasions - 1)));
}

Slope log_log_slope(std::span<const double> x, std::span<const double> y) {
  std::vector<double> log_x, log_y;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!(x[i] > 0) || !(y[i] > 0) || !std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    log_x.push_back(std::log(x[i]));
    log_y.push_back(std::log(y[i]));
  }
  Slope slope;
  slope.points = static_cast<int>(log_x.size());
  if (slope.points < 2) return slope;
  double intercept, cov00, cov01, cov11, squares;
  gsl_fit_linear(log_x.data(), 1, log_y.data(), 1, log_x.size(), &intercept, &slope.value, &cov00,
                 &cov01, &cov11, &squares);
  if (slope.points > 2)
    slope.half_width = std::sqrt(cov11) * gsl_cdf_tdist_Pinv(0.975, slope.points - 2);
  return slope;
}

}  // namespace harness
