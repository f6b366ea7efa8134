// Which steps a sweep runs, how often, and which it calls best.
#include "harness/run/sweep.h"

#include <gtest/gtest.h>

#include "harness/run/fake_machine.h"

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
  const std::vector<Walk> walks{
      {"until two rises", {parabola(200)}, {25, 50, 100, 200, 400, 800}},
      {"through failures, until a step works",
       {parabola(50), refused_above(400)},
       {25, 50, 100, 200, 400, 800, 1600}},
      {"through failures to the end of the ladder",
       {parabola(200), refused_above(1e9)},
       {25, 50, 100, 200, 400, 800, 1600, 3200, 6400}},
      {"from the neighbour's best step in both directions",
       {parabola(200)},
       {25, 50, 100, 200, 400, 800, 200, 400, 800, 100, 50},
       {0.1, 0.01}},
      // 0.5 % is reached at 1/800 s: one more step shows that it does not get faster.
      {"until the finest level is met",
       {.seconds = slowing(1.3), .error = error_of_step(4)},
       {25, 50, 100, 200, 400, 800, 1600}},
      {"until the suite's own level is met",
       {.seconds = slowing(1.3), .error = error_of_step(4)},
       {25, 50, 100, 200, 400},
       {0.1},
       0.02},
      {"for time alone",
       {.seconds = slowing(1.3), .error = error_of_step(4)},
       {25, 50, 100},
       {0.1},
       1},
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
    FakeMachine machine{parabola(200), refused_above(50)};
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
    EXPECT_EQ(cutoffs.size(), timed ? 4u : 18u);  // two time-outs end each walk
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

bool has_level(const PointResult& point, double level) {
  return std::ranges::count(point.best_at_errors, level) > 0;
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
      EXPECT_EQ(has_level(point, level), has_step(point.spec, tenth))
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

}  // namespace
}  // namespace harness
