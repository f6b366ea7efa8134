// Ratios of times: the interval has the coverage that it claims, and claims no more.
#include "harness/base/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "support/effort.h"

namespace harness {
namespace {

using Samples = std::vector<double>;

std::mt19937 seeded() { return std::mt19937(20071114); }

Samples draw(std::size_t n, const std::function<double()>& one) {
  Samples samples(n);
  std::generate(samples.begin(), samples.end(), one);
  return samples;
}

// The fraction of trials in which the interval holds the true factor.
double coverage(int trials, double factor, const std::function<Ratio()>& trial) {
  int inside = 0;
  for (int i = 0; i < trials; ++i) {
    const Ratio ratio = trial();
    EXPECT_LE(ratio.low, ratio.value);
    EXPECT_GE(ratio.high, ratio.value);
    inside += ratio.low <= factor && factor <= ratio.high ? 1 : 0;
  }
  return static_cast<double>(inside) / trials;
}

TEST(Ratio, IntervalHasItsCoverageWhateverTheDistribution) {
  std::mt19937 random = seeded();
  std::lognormal_distribution<double> log_normal(0, 0.1);
  std::exponential_distribution<double> tail;
  const std::function<double()> times[] = {
      [&] { return log_normal(random); },
      // As a machine gives them: never below a floor, with a tail upwards.
      [&] { return 1 + 0.02 * tail(random) + (random() % 10 == 0 ? 0.3 : 0.0); }};
  for (const auto& sizes : {std::pair(5u, 20000), {9u, 20000}, {25u, 400}}) {
    const unsigned n = sizes.first;
    const int trials = inextensible::testing::trials(sizes.second);
    const double doubt = 3 * std::sqrt(0.95 * 0.05 / trials);
    for (const auto& time : times) {
      const double covered = coverage(trials, 1.3, [&] {
        return ratio_of_times(draw(n, [&] { return 1.3 * time(); }), draw(n, time));
      });
      EXPECT_GE(covered, 0.95 - doubt);
      EXPECT_LE(covered, 0.97 + doubt);  // discrete: 96.8 % with five samples
    }
  }
}

TEST(Ratio, IntervalOfOccasionsHoldsAFurtherOne) {
  std::mt19937 random = seeded();
  std::normal_distribution<double> unit;
  // Pairs of programs differ in how much a day changes their ratio.
  const auto ratio_of_pair = [&](double spread) { return 1.3 * std::exp(spread * unit(random)); };
  for (const std::size_t days : {2u, 3u, 5u}) {
    const int trials = inextensible::testing::trials(20000);
    int inside = 0;
    for (int i = 0; i < trials; ++i) {
      const double spread = 0.04 * std::exp(0.3 * unit(random));
      const Samples ratios = draw(days, [&] { return ratio_of_pair(spread); });
      const Ratio ratio = ratio_on_another_day(ratios, 0.04);
      for (const double seen : ratios) EXPECT_TRUE(ratio.low <= seen && seen <= ratio.high);
      const double then = ratio_of_pair(spread);
      inside += ratio.low <= then && then <= ratio.high ? 1 : 0;
    }
    // It holds what was seen, too, which makes it wider.
    EXPECT_NEAR(static_cast<double>(inside) / trials, 0.96, 0.02) << days;
  }
  EXPECT_FALSE(ratio_on_another_day({1.3}, 0.04).known());
  EXPECT_GE(ratio_on_another_day({1.3, 1.3}, 0.001, 0.5).high, 1.3 * std::exp(0.5));
}

TEST(Ratio, ScatterIsThatBetweenOccasionsWhateverOneSlowsDown) {
  std::mt19937 random = seeded();
  std::normal_distribution<double> unit;
  const double slower[] = {1, 1.4, 0.7};  // on each day, all programs
  std::vector<Samples> times;
  for (int program = 0; program < 400; ++program) {
    const double own = std::exp(3 * unit(random));
    Samples& of = times.emplace_back();
    for (const double day : slower) of.push_back(own * day * std::exp(0.05 * unit(random)));
  }
  EXPECT_NEAR(scatter_of(times), 0.05 * std::sqrt(2), 0.004);
  times.push_back({100, 1});  // was not timed on the third
  EXPECT_NEAR(scatter_of(times), 0.05 * std::sqrt(2), 0.004);
  EXPECT_TRUE(std::isnan(scatter_of({{1, 2}})) && std::isnan(scatter_of({{1}, {2}})));
}

TEST(Ratio, IntervalMatchesTheTablesOfTheTest) {
  // Where no pair of samples ties, the interval leaves out the c - 1 least and largest quotients;
  // Hollander and Wolfe's table of the two-sided 5 % test has c = 18 for 9 and 9, 3 for 5 and 5.
  const auto with = [](int n) {
    Samples a, b;  // whose quotients are exp(0), exp(0.001), exp(0.002) ...
    for (int i = 0; i < n; ++i) {
      a.push_back(std::exp(0.001 * i));
      b.push_back(std::exp(-0.001 * n * i));
    }
    return std::lround(1000 * std::log(ratio_of_times(a, b).low)) + 1;
  };
  EXPECT_EQ(with(9), 18);
  EXPECT_EQ(with(5), 3);
  EXPECT_EQ(with(4), 1);
}

TEST(Ratio, SamplesOfOtherSpreadsHardlyLoseCoverage) {
  if (inextensible::testing::sanitized) GTEST_SKIP() << "too slow with sanitizers";
  std::mt19937 random = seeded();
  std::lognormal_distribution<double> narrow(0, 0.01), wide(0, 0.1);
  const double covered = coverage(20000, 1.0, [&] {
    return ratio_of_times(draw(9, [&] { return narrow(random); }),
                          draw(9, [&] { return wide(random); }));
  });
  EXPECT_GE(covered, 0.90);
}

TEST(Ratio, WithoutSamplesAndWithoutAPairNothingIsKnown) {
  const Ratio three = ratio_of_times({1.0, 1.01, 1.02}, {50.0, 51.0, 52.0});
  EXPECT_FALSE(three.known() || three.below(1) || three.above(0.001));
  EXPECT_NEAR(three.value, 1.0 / 50, 1e-12);
  EXPECT_TRUE(ratio_of_times({1.0, 1.01, 1.02, 1.03}, {50.0, 51.0, 52.0, 53.0}).below(1));
  EXPECT_TRUE(std::isnan(ratio_of_times({}, {1.0}, 0.1).value));
}

TEST(Ratio, TheWiderOfSamplesAndPairCounts) {
  const Samples a{1.00, 1.01, 1.02, 1.03, 1.04, 1.05}, b{2.0, 2.01, 2.02, 2.03, 2.04, 2.05};
  const Ratio samples = ratio_of_times(a, b), quiet = ratio_of_times(a, b, 1e-6);
  EXPECT_EQ(std::pair(quiet.low, quiet.high), std::pair(samples.low, samples.high));
  for (const Ratio& noisy : {ratio_of_times(a, b, 0.2), ratio_of_times({1.0}, {2.0}, 0.2)}) {
    EXPECT_NEAR(noisy.low, noisy.value * std::exp(-0.2), 1e-12);
    EXPECT_NEAR(noisy.high, noisy.value * std::exp(0.2), 1e-12);
  }
}

// Each place of a sweep has a speed of its own for each name, which no repetition shows: samples
// alone find differences in nine of ten pairs, the pair's own noise in one of twenty.
TEST(Ratio, AProgramAgainstItselfShowsNoDifference) {
  std::mt19937 random = seeded();
  std::normal_distribution<double> place(0, 0.05), repetition(0, 0.01);
  const auto sample = [&] {
    const double here = place(random);
    return draw(9, [&] { return std::exp(here + repetition(random)); });
  };
  Samples log_ratios;
  for (int i = 0; i < 2000; ++i)
    log_ratios.push_back(std::abs(std::log(time_of(sample()) / time_of(sample()))));
  const double noise = quantile(log_ratios, 0.95);
  const double alone = coverage(5000, 1, [&] { return ratio_of_times(sample(), sample()); });
  const double paired =
      coverage(5000, 1, [&] { return ratio_of_times(sample(), sample(), noise); });
  EXPECT_LT(alone, 0.6);
  EXPECT_NEAR(paired, 0.95, 0.02);
}

// Some 95 % of 95 % intervals hold the truth. Fewer than 360 of 400 do with a chance below 1e-4.
TEST(Slope, IntervalsHoldTheTruthAsOftenAsTheySay) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.1);
  int inside = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<double> sizes, seconds;
    for (const double n : {101, 201, 317, 501, 1001}) {
      sizes.push_back(n);
      seconds.push_back(std::exp(noise(random)) * 1e-7 * std::pow(n, 1.1));
    }
    const Slope slope = log_log_slope(sizes, seconds);
    inside += slope.low() <= 1.1 && 1.1 <= slope.high();
  }
  EXPECT_GE(inside, 360);
  EXPECT_LT(inside, 400);
}

}  // namespace
}  // namespace harness
