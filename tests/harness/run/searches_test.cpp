// The searches for a step on a disturbed machine with known times, and for a stiffness by formulas.
#include <gtest/gtest.h>

#include <random>

#include "harness/base/statistics.h"
#include "harness/run/calibration.h"
#include "harness/run/fake_machine.h"
#include "harness/run/step_search.h"

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

// First samples are given; every later one is the true time.
TEST(NoisySearch, IsNotMisledByFirstSamples) {
  const std::vector<double> false_rises{1.0, 0.9, 1.5, 1.5, 0.6, 0.5, 0.9, 2.0, 4.0},
      falls{1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.9, 2.0, 4.0},
      false_falls{9, 0.9, 0.5, 0.6, 1.5, 1.5, 0.9, 1.2, 2.4},
      rises{9, 0.9, 0.5, 0.6, 0.7, 0.8, 0.9, 1.2, 2.4},
      equal{1.0, 1.02, 1.01, 1.025, 0.7, 0.9, 1.6}, clear{3.2, 1, 3.2, 6.4, 9};
  const struct {
    const char* what;
    std::optional<std::size_t> start;
    std::size_t best, finest_tried;
    std::vector<double> first, later;
    bool samples_again = true;
  } ladders[] = {{"two false rises that look clear", {}, 5, 7, false_rises, falls},
                 {"the same to coarser steps", 6, 2, 8, false_falls, rises},
                 {"equal times are not a rise", {}, 4, 6, equal, equal},
                 {"what is clearly slower is not run again", {}, 1, 3, clear, clear, false}};
  for (const auto& ladder : ladders) {
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
    const auto sample = [&](std::size_t rung) {
      again = true;
      points[rung].samples.push_back(ladder.later[rung]);
    };
    EXPECT_EQ(find_best_steps({points.size(), run, sample, {}, 1, ladder.start}).best, ladder.best)
        << ladder.what;
    EXPECT_EQ(tried, ladder.finest_tried) << ladder.what;
    EXPECT_EQ(again, ladder.samples_again) << ladder.what;
  }
}

// Coarse steps are fast and wrong: the first right one, between halvings, is many times slower.
TEST(StepSearch, LooksBetweenRungsForTheFirstStepThatIsRight) {
  constexpr std::size_t first_right = 7;
  std::vector<PointResult> points(13);
  const auto run = [&](std::size_t rung, double useful) -> const PointResult& {
    PointResult& point = points[rung];
    const double seconds = std::exp2(0.5 * static_cast<double>(rung));
    point.status = seconds > useful ? PointStatus::timeout : PointStatus::ok;
    point.samples = {seconds};
    point.measures.gap = 0;
    point.measures.trajectory = rung < first_right ? 0.05 : 0.003;
    return point;
  };
  const BestSteps found = find_best_steps({points.size(), run, [](auto) {}, {0.02}, 2});
  EXPECT_EQ(found.best, 0u);
  EXPECT_EQ(found.seconds.at(0.02).begin()->first, first_right);
}

constexpr double limit = 0.01;

// A run that is cut short as real ones are.
CalibrationTrial judged(double strain) {
  const double reached = std::min(strain, 1.05 * calibration_cut_short * limit);
  return {reached <= limit ? PointStatus::ok : PointStatus::strain_missed, reached, 1, "formula"};
}

double tension_law(double stiffness) { return 3 / stiffness; }

// From above, the law leads to the answer; from below, runs are cut short and say little; and if
// tension grows with stiffness, the law does not hold.
TEST(Calibration, FindsItsWay) {
  const auto growing = [](double stiffness) {
    return 0.3 * std::pow(stiffness, -0.5) * (1 + 0.05 * std::sin(7 * std::log(stiffness)));
  };
  const struct {
    std::function<double(double)> strain;
    double guess;
    int most_runs;
  } rows[] = {{tension_law, 320, 1}, {tension_law, 400, 2}, {tension_law, 3000, 2},
              {tension_law, 3e6, 2}, {tension_law, 290, 8}, {tension_law, 100, 8},
              {tension_law, 10, 8},  {tension_law, 0.1, 8}, {growing, 1, 16},
              {growing, 100, 16},    {growing, 1e4, 16},    {growing, 1e6, 16}};
  for (const auto& row : rows) {
    int runs = 0;
    const Calibration found =
        calibrate_stiffness(limit, row.guess, [&](double stiffness) -> CalibrationTrial {
          ++runs;
          return judged(row.strain(stiffness));
        });
    ASSERT_TRUE(found.stiffness) << row.guess;
    EXPECT_LE(row.strain(*found.stiffness), limit);
    EXPECT_GE(row.strain(*found.stiffness), 0.85 * limit);
    EXPECT_EQ(found.runs, runs);
    EXPECT_LE(runs, row.most_runs) << row.guess;
  }
}

// A time-out must not count as "too soft", which would lead to stiffer, slower springs.
TEST(Calibration, GivesUpAndSaysWhy) {
  const CalibrationTrial soft{PointStatus::strain_missed, 0.02, 1, ""},
      good{PointStatus::ok, 0.1 * limit, 1, ""},
      slow{PointStatus::timeout, 0.0035, 61.5, "stopped at t = 0.25 s"},
      fails{PointStatus::not_converged, 0.002, 1, "step 3: singular"};
  const struct {
    CalibrationTrial first, later;
    PointStatus status;
    int runs;
  } rows[] = {{soft, soft, PointStatus::strain_missed, calibration_run_limit},
              {slow, slow, PointStatus::skipped, 1},
              {good, slow, PointStatus::skipped, 2},
              {fails, fails, PointStatus::not_converged, calibration_failure_limit}};
  for (const auto& row : rows) {
    int runs = 0;
    const Calibration found = calibrate_stiffness(
        limit, 1000, [&](double) { return ++runs == 1 ? row.first : row.later; });
    EXPECT_FALSE(found.stiffness);
    EXPECT_EQ(found.status, row.status);
    EXPECT_EQ(found.runs, row.runs) << found.detail;
    EXPECT_TRUE(found.detail.ends_with(row.later.detail)) << found.detail;
  }
}

// Runs fail above or below some stiffness, like Newton's iteration, with the strain so far.
TEST(Calibration, LooksOnBothSidesOfARunThatFailed) {
  for (const bool stiff_ones_fail : {true, false}) {
    const auto works = [&](double stiffness) {
      return stiff_ones_fail ? stiffness < 330 : stiffness > 301;
    };
    for (const double guess : stiff_ones_fail ? std::vector{400.0, 1000.0} : std::vector{150.0}) {
      int failures = 0;
      const Calibration found =
          calibrate_stiffness(limit, guess, [&](double stiffness) -> CalibrationTrial {
            const double strain = tension_law(stiffness);
            if (works(stiffness))
              return {strain <= limit ? PointStatus::ok : PointStatus::strain_missed, strain, 1,
                      ""};
            ++failures;
            return {PointStatus::not_converged, 0.4 * strain, 1, "Newton"};
          });
      ASSERT_TRUE(found.stiffness) << guess;
      EXPECT_TRUE(works(*found.stiffness));
      EXPECT_LE(tension_law(*found.stiffness), limit);
      EXPECT_GE(tension_law(*found.stiffness), 0.85 * limit);
      EXPECT_GT(failures, 0);
    }
  }
}

}  // namespace
}  // namespace harness
