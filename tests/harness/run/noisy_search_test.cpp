// The search for a step on a machine that is disturbed half of the time, with a stand-in whose true
// times are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "harness/base/statistics.h"
#include "harness/run/step_search.h"
#include "harness/run/sweep.h"

namespace harness {
namespace {

constexpr double coarsest = 1.0 / 25;
constexpr int rungs = 10;

// Times over rungs: a tenth of a second at the best one, 15 % more beside it, 60 % two away.
double true_time(int rung, int best) { return 0.1 * (1 + 0.15 * (rung - best) * (rung - best)); }

// Every other sample is disturbed, by 40 % in the mean; the others by 1 %.
double disturbed(double seconds, std::mt19937_64& random) {
  std::exponential_distribution<double> tail(1);
  return seconds * (1 + (random() % 2 == 0 ? 0.01 : 0.4) * tail(random));
}

int rung_of(const PointSpec& spec) {
  return static_cast<int>(std::lround(std::log2(coarsest / spec.step)));
}

// By the rules of this program.
PointResult best_point(int best, std::mt19937_64& random) {
  Suite suite;
  suite.reps = 7;
  SweepSpec sweep;
  sweep.sweep = "strain";
  sweep.scene = "chain";
  sweep.contestants = {{"fast_projection", "fast_projection"}};
  sweep.limits = {0.01};
  sweep.resolutions = {10};
  sweep.coarsest = coarsest;
  sweep.finest = coarsest / (1 << (rungs - 1));
  suite.sweeps = {sweep};
  SweepRunners runners;
  runners.run = [&](const PointSpec& spec, const RunLimits&, std::optional<double>) {
    PointResult point;
    point.spec = spec;
    point.status = PointStatus::ok;
    point.steps_planned = static_cast<int>(std::lround(1 / spec.step));
    point.samples = {disturbed(true_time(rung_of(spec), best), random)};
    return point;
  };
  runners.repeat = [&](PointResult& point, const RunLimits&) {
    point.samples.push_back(disturbed(true_time(rung_of(point.spec), best), random));
  };
  for (PointResult& point : run_sweep(suite, plan(suite, {}), {}, runners).points)
    if (point.best) return std::move(point);
  return {};
}

struct Chosen {
  int rung;
  double seconds;
};

// As it was once: one sample a step until two rises, then the median of five for what is close.
Chosen chosen_by_medians(int best, std::mt19937_64& random) {
  const auto sample = [&](int rung) { return disturbed(true_time(rung, best), random); };
  std::vector<double> first;
  double least = 1e300;
  for (int rung = 0, rises = 0; rung < rungs && rises < 2; ++rung) {
    first.push_back(sample(rung));
    rises = first.back() < least ? 0 : rises + 1;
    least = std::min(least, first.back());
  }
  Chosen chosen{-1, 1e300};
  for (int rung = 0; rung < static_cast<int>(first.size()); ++rung) {
    const double one = first[static_cast<std::size_t>(rung)];
    if (one > 1.2 * least) continue;
    const double median =
        quantile({one, sample(rung), sample(rung), sample(rung), sample(rung)}, 0.5);
    if (median < chosen.seconds) chosen = {rung, median};
  }
  return chosen;
}

TEST(NoisySearch, FindsTheTrueBestStepWhereOneSampleDidNot) {
  constexpr int seeds = 1000;
  int found = 0, found_once = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const int best = 1 + seed % (rungs - 2);
    std::mt19937_64 random(static_cast<unsigned>(seed)), again(static_cast<unsigned>(seed));
    found += rung_of(best_point(best, random).spec) == best ? 1 : 0;
    found_once += chosen_by_medians(best, again).rung == best ? 1 : 0;
  }
  std::cout << "seeds 1 to " << seeds << ": the true best step in " << found
            << "; by one sample a step and medians of five in " << found_once << '\n';
  EXPECT_GE(found, 0.95 * seeds);
  EXPECT_LT(found_once, 0.85 * seeds);
}

TEST(NoisySearch, OneProgramUnderTwoNamesIsWithinSixPercentOfItself) {
  constexpr int seeds = 500, best = 4;
  std::vector<double> apart, apart_once;
  for (int seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(static_cast<unsigned>(seed));
    apart.push_back(std::abs(
        std::log(best_point(best, random).seconds() / best_point(best, random).seconds())));
    apart_once.push_back(std::abs(std::log(chosen_by_medians(best, random).seconds /
                                           chosen_by_medians(best, random).seconds)));
  }
  std::cout << "seeds 1 to " << seeds << ": q95 " << quantile(apart, 0.95)
            << "; by medians of five " << quantile(apart_once, 0.95) << '\n';
  EXPECT_LT(quantile(apart, 0.95), 0.06);
  EXPECT_GT(quantile(apart_once, 0.95), 0.2);
}

// A ladder whose first samples and true times are given; every later sample is true.
class Ladder {
 public:
  Ladder(std::vector<double> first, std::vector<double> later) : later_(std::move(later)) {
    points_.resize(first.size());
    for (std::size_t rung = 0; rung < first.size(); ++rung) {
      points_[rung].status = PointStatus::ok;
      points_[rung].samples = {first[rung]};
    }
  }

  std::optional<std::size_t> best(std::optional<std::size_t> start) {
    StepSearch search(
        points_.size(),
        [this](std::size_t rung) -> const PointResult& {
          tried_ = std::max(tried_, rung);
          return points_[rung];
        },
        [this](std::size_t rung) -> const PointResult& {
          points_[rung].samples.push_back(later_[rung]);
          return points_[rung];
        });
    return search.find(start);
  }
  std::size_t tried() const { return tried_; }
  std::size_t samples(std::size_t rung) const { return points_[rung].samples.size(); }

 private:
  std::vector<PointResult> points_;
  std::vector<double> later_;
  std::size_t tried_ = 0;
};

TEST(NoisySearch, GoesOnWhereTheBestIsAnEndOfWhatWasTried) {
  const std::vector<double> later{1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.9, 2.0, 4.0};
  std::vector<double> first = later;
  first[2] = first[3] = 1.5;  // two false rises that look clear
  Ladder ladder(first, later);
  EXPECT_EQ(ladder.best({}), 5u);
  EXPECT_EQ(ladder.tried(), 7u);
}

TEST(NoisySearch, GoesOnToCoarserStepsToo) {
  const std::vector<double> later{9, 0.9, 0.5, 0.6, 0.7, 0.8, 0.9, 1.2, 2.4};
  std::vector<double> first = later;
  first[5] = first[4] = 1.5;
  Ladder ladder(first, later);
  EXPECT_EQ(ladder.best(6), 2u);
}

TEST(NoisySearch, WhatIsClearlySlowerIsNotRunAgain) {
  const std::vector<double> times{3.2, 1.0, 3.2, 6.4, 9, 9};
  Ladder ladder(times, times);
  EXPECT_EQ(ladder.best({}), 1u);
  for (std::size_t rung = 0; rung < times.size(); ++rung) EXPECT_EQ(ladder.samples(rung), 1u);
  EXPECT_EQ(ladder.tried(), 3u);
}

TEST(NoisySearch, EqualTimesAreNoRise) {
  Ladder ladder({1.0, 1.02, 1.01, 1.025, 0.7, 0.9, 1.6}, {1.0, 1.02, 1.01, 1.025, 0.7, 0.9, 1.6});
  EXPECT_EQ(ladder.best({}), 4u);
}

}  // namespace
}  // namespace harness
