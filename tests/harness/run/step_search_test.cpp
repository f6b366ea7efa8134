// The search for a step on a machine that is disturbed half of the time, with a stand-in whose true
// times are known.
#include "harness/run/step_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "harness/base/statistics.h"
#include "harness/run/fake_machine.h"

namespace harness {
namespace {

constexpr int rungs = 10;

int rung_of(const PointSpec& spec) {
  return static_cast<int>(std::lround(std::log2(0.04 / spec.step)));
}

// Times over rungs: a tenth of a second at the best one, 15 % more beside it, 60 % two away. Every
// other sample is disturbed, by 40 % in the mean; the others by 1 %.
PointResult best_point(int best, std::mt19937_64& random) {
  Suite suite = suite_of_chain({0.01});
  suite.reps = 7;
  suite.sweeps[0].refine = true;
  suite.sweeps[0].finest = 0.04 / (1 << (rungs - 1));
  const auto seconds = [&](const PointSpec& spec) {
    std::exponential_distribution<double> tail(1);
    const double away = rung_of(spec) - best;
    const double disturbed = 1 + (random() % 2 == 0 ? 0.01 : 0.4) * tail(random);
    return 0.1 * (1 + 0.15 * away * away) * disturbed;
  };
  FakeMachine machine{seconds};
  machine.again = [&seconds](const PointResult& point) { return seconds(point.spec); };
  for (PointResult& point : sweep(suite, machine).points)
    if (point.best) return std::move(point);
  return {};
}

TEST(NoisySearch, FindsTheTrueBestStep) {
  constexpr int seeds = 1000;
  int found = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const int best = 1 + seed % (rungs - 2);
    std::mt19937_64 random(static_cast<unsigned>(seed));
    found += rung_of(best_point(best, random).spec) == best ? 1 : 0;
  }
  EXPECT_GE(found, 0.95 * seeds);
}

TEST(NoisySearch, OneProgramUnderTwoNamesIsWithinSixPercentOfItself) {
  std::vector<double> apart;
  for (unsigned seed = 1; seed <= 500; ++seed) {
    std::mt19937_64 random(seed);
    apart.push_back(
        std::abs(std::log(best_point(4, random).seconds() / best_point(4, random).seconds())));
  }
  EXPECT_LT(quantile(apart, 0.95), 0.06);
}

// A ladder whose first samples are given; every later sample is the true time.
struct Ladder {
  const char* what;
  std::vector<double> first, later;
  std::optional<std::size_t> start;
  std::size_t best;
  std::size_t finest_tried;
  bool samples_again = true;
};

TEST(NoisySearch, IsNotMisledByFirstSamples) {
  const std::vector<double> equal{1.0, 1.02, 1.01, 1.025, 0.7, 0.9, 1.6},
      clear{3.2, 1, 3.2, 6.4, 9};
  for (const Ladder& ladder :
       {Ladder{"two false rises that look clear",
               {1.0, 0.9, 1.5, 1.5, 0.6, 0.5, 0.9, 2.0, 4.0},
               {1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.9, 2.0, 4.0},
               {},
               5,
               7},
        Ladder{"the same to coarser steps",
               {9, 0.9, 0.5, 0.6, 1.5, 1.5, 0.9, 1.2, 2.4},
               {9, 0.9, 0.5, 0.6, 0.7, 0.8, 0.9, 1.2, 2.4},
               6,
               2,
               8},
        Ladder{"equal times are no rise", equal, equal, {}, 4, 6},
        Ladder{"what is clearly slower is not run again", clear, clear, {}, 1, 3, false}}) {
    std::vector<PointResult> points(ladder.first.size());
    for (std::size_t rung = 0; rung < points.size(); ++rung) {
      points[rung].status = PointStatus::ok;
      points[rung].samples = {ladder.first[rung]};
    }
    std::size_t tried = 0;
    bool again = false;
    const auto run = [&](std::size_t rung, double) -> const PointResult& {
      tried = std::max(tried, rung);
      return points[rung];
    };
    const auto sample = [&](std::size_t rung) -> const PointResult& {
      again = true;
      points[rung].samples.push_back(ladder.later[rung]);
      return points[rung];
    };
    EXPECT_EQ(find_best_steps({points.size(), run, sample, {}, 1, ladder.start}).best, ladder.best)
        << ladder.what;
    EXPECT_EQ(tried, ladder.finest_tried) << ladder.what;
    EXPECT_EQ(again, ladder.samples_again) << ladder.what;
  }
}

}  // namespace
}  // namespace harness
