// Which steps a sweep runs, how often, and which it calls best; on a disturbed machine with known
// times, too. The search for a stiffness, by formulas.
#include "harness/run/sweep.h"

#include <gtest/gtest.h>

#include <random>

#include "harness/base/statistics.h"
#include "harness/run/calibration.h"
#include "harness/run/fake_machine.h"
#include "harness/run/step_search.h"

namespace harness {
namespace {

// A search, and the steps that it runs, as 1/n s.
struct Walk {
  const char* what;
  FakeMachine machine;
  std::vector<int> steps;
  std::vector<double> limits = {0.1};
  double finest_error = 0;  // 0: that of suites
};

TEST(StepSearch, RunsFromCoarseToFineAsLongAsThatIsOfUse) {
  const FakeMachine gradual{.seconds = slowing(1.3), .error = error_of_step(4)};
  const std::vector<Walk> walks{
      {"until two rises", {parabola(200)}, {25, 50, 100, 200, 400, 800}},
      {"through failures, until a step works",
       {parabola(50), refused_above(400)},
       {25, 50, 100, 200, 400, 800, 1600}},
      {"through timeouts that get farther",
       {.seconds = parabola(400),
        .status = refused_above(300, PointStatus::timeout),
        .reached = [](const PointSpec& spec) { return 0.003 / spec.step; }},
       {25, 50, 100, 200, 400, 800, 1600}},
      {"until two timeouts get no farther",
       {.seconds = parabola(400),
        .status = refused_above(300, PointStatus::timeout),
        .reached = [](const PointSpec&) { return 0.5; }},
       {25, 50}},
      {"through failures to the end of the ladder",
       {parabola(200), refused_above(1e9)},
       {25, 50, 100, 200, 400, 800, 1600, 3200, 6400}},
      {"from the neighbour's best step in both directions",
       {parabola(200)},
       {25, 50, 100, 200, 400, 800, 200, 400, 800, 100, 50},
       {0.1, 0.01}},
      // 0.5 % is reached at 1/800 s: one more step shows that it does not get faster.
      {"until the finest level is met", gradual, {25, 50, 100, 200, 400, 800, 1600}},
      {"until the suite's own level is met", gradual, {25, 50, 100, 200, 400}, {0.1}, 0.02},
      {"for time alone", gradual, {25, 50, 100}, {0.1}, 1},
      {"until the finest level to which the reference is known",
       {.seconds = slowing(1.3), .error = error_of_step(4), .gap = 0.02 / sure_gaps},
       {25, 50, 100, 200, 400}},
      // 1, 2.5, 6.25, 15.6, 39 s: the last is stopped.
      {"until time has risen thirtyfold",
       {.seconds = slowing(2.5), .error = error_of_step(1000), .stops = true},
       {25, 50, 100, 200, 400}},
      // A step that meets the next level is not compared with a fast wrong one: 16 % at 1 s.
      {"through thirtyfold times that meet another level",
       {.seconds = slowing(3), .error = error_of_step(4), .stops = true},
       {25, 50, 100, 200, 400, 800, 1600}},
      {"until the error stays",
       {.seconds = slowing(1.1),
        .error = [](const PointSpec& spec) { return 0.2 + 0.01 * spec.step; }},
       {25, 50, 100, 200, 400, 800}},
      // Several steps lead to the same wrong folds.
      {"past an error that stays for a while",
       {.seconds = slowing(1.3),
        .error = [](const PointSpec& spec) { return spec.step > 0.004 ? 0.2 : spec.step; }},
       {25, 50, 100, 200, 400, 800}},
      {"until two runs in a row fail",
       {.seconds = slowing(1.1),
        .status =
            [](const PointSpec& spec) {
              return spec.step < 0.015 ? PointStatus::energy_gained : PointStatus::ok;
            },
        .error = error_of_step(1000)},
       {25, 50, 100, 200}}};
  for (Walk walk : walks) {
    Suite suite = suite_of_chain(walk.limits);
    if (walk.finest_error > 0) suite.finest_error = walk.finest_error;
    const auto outcome = sweep(suite, walk.machine);
    EXPECT_EQ(walk.machine.steps(), walk.steps) << walk.what;
    EXPECT_EQ(outcome.points.size(), walk.steps.size()) << walk.what;
  }
}

// The best step is found even between rungs that halve, and no run is made twice.
TEST(StepSearch, RefinesTheBestStepByFactorsOfOnePointTwo) {
  Suite suite = suite_of_chain({0.01});
  suite.sweeps[0].refine = true;
  for (const double rate : {100.0, 120.0, 144.0, 168.0, 200.0, 240.0, 288.0, 336.0}) {
    FakeMachine machine{parabola(rate)};
    const auto outcome = sweep(suite, machine);
    std::vector<int> steps = machine.steps();
    std::ranges::sort(steps);
    EXPECT_EQ(std::ranges::adjacent_find(steps), steps.end()) << rate;
    EXPECT_LE(steps.size(), 14U) << rate;
    for (const auto& point : outcome.points)
      EXPECT_EQ(point.best, has_step(point.spec, rate)) << rate;
  }
}

// Every step tried is in the outcome; candidates, or all points of a step sweep, have all samples.
TEST(StepSearch, SamplesWhatMayBeBest) {
  for (const std::string kind : {"strain", "step", "every step"}) {
    Suite suite = suite_of_chain({0.1, 0.01});
    suite.sweeps[0].every_step = kind == "every step";
    if (kind == "step") suite.sweeps[0].sweep = kind;
    FakeMachine machine{[](const auto& spec) { return 1.8 * parabola(200)(spec) - 0.08; },
                        refused_above(50)};  // 0.1 s, its neighbors 0.28 s
    const auto outcome = sweep(suite, machine);
    EXPECT_EQ(outcome.points.size() == 2 * 9u, kind != "strain") << kind;
    for (const auto& point : outcome.points) {
      EXPECT_EQ(point.ok(), point.spec.step < 1.0 / 49) << point.spec.id();
      EXPECT_EQ(point.best, has_step(point.spec, 200)) << point.spec.id();
      EXPECT_EQ(point.measures.unknown_because, "no run came to an end that could be judged");
      const bool sampled = point.best || kind == "step";
      EXPECT_EQ(point.samples.size(), !point.ok() ? 0u : sampled ? 3u : 1u) << point.spec.id();
    }
  }
}

TEST(StepSearch, SaysWhereTheBestStepIsAnEndOfTheLadder) {
  Suite suite = suite_of_chain({0.1, 0.01});
  suite.sweeps[0].every_step = true;
  const auto expect = [&suite](double best, const std::string& end) {
    FakeMachine machine{parabola(best)};
    for (const PointResult& point : sweep(suite, machine).points)
      EXPECT_EQ(point.at_ladder_end, point.best ? end : "") << point.spec.id();
  };
  expect(3, "coarsest");
  expect(200, "");
  expect(50000, "finest");
  suite.sweeps[0].coarsest = suite.sweeps[0].finest = 0.01;
  expect(100, "");
}

// The slower contestant needs 100 times the other's time: it is stopped at 30 times, at each limit
// again. With --untimed, which runs finish must not depend on the machine.
TEST(StepSearch, StopsRunsFarBehindTheFastestUnlessTimesAreNotUsed) {
  for (const bool timed : {true, false}) {
    Suite suite = suite_of_chain({0.1, 0.01});
    suite.sweeps[0].contestants.push_back({"jacobi", "jacobi"});
    suite.sweeps[0].every_step = !timed;
    if (!timed) suite.far_behind = std::numeric_limits<double>::infinity();
    FakeMachine machine{[](const PointSpec& spec) {
      return parabola(200)(spec) * (spec.solver == "jacobi" ? 100 : 1);
    }};
    machine.stops = true;
    for (const auto& point : sweep(suite, machine).points)
      EXPECT_NE(point.status, PointStatus::skipped);
    std::vector<double> cutoffs;
    for (std::size_t i = 0; i < machine.specs.size(); ++i)
      if (machine.specs[i].solver == "jacobi") cutoffs.push_back(machine.hopeless[i]);
    EXPECT_EQ(cutoffs.size(), timed ? 4u : 18u);  // two timeouts end each walk
    for (const double cutoff : cutoffs)
      EXPECT_TRUE(timed ? std::abs(cutoff - 30 * 0.1) < 1e-9 : cutoff >= 1e300) << cutoff;
  }
}

// A solver that also failed otherwise may succeed at the next limit.
TEST(StepSearch, SkipsATighterLimitOnlyAfterNothingButTimeouts) {
  for (const bool all : {true, false}) {
    FakeMachine machine{parabola(200), [all](const PointSpec& spec) {
                          if (spec.strain_limit < 0.05) return PointStatus::ok;
                          return !all && spec.step > 0.03 ? PointStatus::energy_gained
                                                          : PointStatus::timeout;
                        }};
    const auto outcome = sweep(suite_of_chain({0.1, 0.01}), machine);
    EXPECT_EQ(outcome.points.back().status == PointStatus::skipped, all);
    EXPECT_EQ(std::ranges::any_of(outcome.points, &PointResult::ok), !all);
  }
}

TEST(ErrorLevels, EachHasItsFastestStepBesideTheOneOfAnyMotion) {
  FakeMachine machine{parabola(100)};
  machine.error = [](const PointSpec& spec) {
    return spec.step * (spec.strain_limit < 0.05 ? 10 : 1);
  };
  const auto outcome = sweep(suite_of_chain({0.1, 0.01}), machine);
  // At 10 % the error is the step: 1/100 s is right to 1 % and fastest, 1/200 s the coarsest that
  // is to 0.5 %. At 1 % it is ten steps: 1/100 s is right to 10 %, 1/200 s to 5 %, 1/800 s to 2 %,
  // 1/1600 s to 1 %, and 1/3200 s to 0.5 %.
  const std::map<double, double> wanted{
      {0.1, 100}, {0.05, 200}, {0.02, 800}, {0.01, 1600}, {0.005, 3200}};
  for (const PointResult& point : outcome.points) {
    EXPECT_EQ(point.best, has_step(point.spec, 100)) << point.spec.id();
    for (const auto& [level, n] : wanted) {
      const double tenth = point.spec.strain_limit > 0.05 ? (level < 0.01 ? 200 : 100) : n;
      EXPECT_EQ(std::ranges::count(point.best_at_errors, level) > 0, has_step(point.spec, tenth))
          << point.spec.id() << " at " << level;
    }
    // What is near to a best step is looked at again before the search ends.
    const bool best = point.best || !point.best_at_errors.empty();
    EXPECT_TRUE(point.samples.size() == 3u || (!best && point.samples.size() == 1u))
        << point.spec.id();
  }
  EXPECT_EQ(machine.specs.size(), outcome.points.size()) << "no step is run for each level again";
}

TEST(TimesAgain, AreThoseOfTheOtherOccasionAlone) {
  FakeMachine machine{.seconds = parabola(200)};
  const Suite suite = suite_of_chain({0.1, 0.01});
  std::vector<PointResult> best;
  for (const PointResult& point : sweep(suite, machine).points)
    if (point.best) best.push_back(point);
  ASSERT_EQ(best.size(), 2u);
  int runs = 0;
  const Runner slower = [&](const PointSpec& spec, const RunLimits& limits) {
    EXPECT_TRUE(limits.sample_of) << "nothing is judged again";
    PointResult more(spec);
    if (++runs != 1) more.samples = {3 * limits.sample_of->samples.front()};  // 1: it failed
    return more;
  };
  const auto again = time_again(suite, best, {}, slower);
  ASSERT_EQ(again.size(), 2u);
  EXPECT_TRUE(again[0].samples.empty());
  EXPECT_EQ(again[1].samples.size(), static_cast<std::size_t>(suite.reps));
  EXPECT_DOUBLE_EQ(again[1].samples.front(), 3 * best[1].samples.front());
}

TEST(ErrorLevels, AnErrorThatIsNotKnownIsNoErrorWithinALevel) {
  FakeMachine machine{.seconds = parabola(200), .error = error_of_step(std::nan(""))};
  for (const auto& point : sweep(suite_of_chain({0.1}), machine).points)
    EXPECT_TRUE(point.best_at_errors.empty());
}

// ---- Searches by themselves ----

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

TEST(NoisySearch, FindsTheTrueBestStepAndOneProgramUnderTwoNamesIsWithinSixPercentOfItself) {
  constexpr int seeds = 1000;
  int found = 0;
  std::vector<double> apart;
  for (int seed = 1; seed <= seeds; ++seed) {
    const int best = 1 + seed % (rungs - 2);
    std::mt19937_64 random(static_cast<unsigned>(seed));
    const PointResult one = best_point(best, random), other = best_point(best, random);
    found += rung_of(one.spec) == best ? 1 : 0;
    apart.push_back(std::abs(std::log(one.seconds() / other.seconds())));
  }
  EXPECT_GE(found, 0.95 * seeds);
  EXPECT_LT(quantile(apart, 0.95), 0.06);
}

// First samples are given; every later one is the true time.
TEST(NoisySearch, IsNotMisledByFirstSamples) {
  const std::vector<double> false_rises{1.0, 0.9, 2.2, 2.2, 0.6, 0.5, 0.9, 2.0, 4.0},
      falls{1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.9, 2.0, 4.0},
      false_falls{9, 0.9, 0.5, 0.6, 2.2, 2.2, 0.9, 1.2, 2.4},
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
