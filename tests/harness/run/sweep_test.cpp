// The step search and the interleaved repetitions, with a fake clock: no solver runs here.
#include "harness/run/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "harness/base/errors.h"

namespace harness {
namespace {

// One search family on the chain: limits 10 % and 1 %.
Suite one_family() {
  Suite suite;
  suite.name = "test";
  suite.reps = 3;
  SweepSpec sweep;
  sweep.sweep = "strain";
  sweep.scene = "chain";
  sweep.contestants = {{"fast_projection", "fast_projection"}};
  sweep.limits = {0.1, 0.01};
  sweep.resolutions = {10};
  sweep.finest = 1.0 / 6400;
  sweep.refine = false;
  suite.sweeps = {sweep};
  return suite;
}

// A runner whose time over steps is a parabola in log step with its minimum at `best`, failing
// above `largest`.
SweepRunners fake(double best, double largest, std::vector<double>* steps) {
  SweepRunners runners;
  runners.run = [=](const PointSpec& spec, const RunLimits&, std::optional<double>) {
    if (steps) steps->push_back(spec.step);
    PointResult point;
    point.spec = spec;
    point.steps_planned = static_cast<int>(std::lround(1 / spec.step));
    if (spec.step > largest * (1 + 1e-9)) {
      point.status = PointStatus::not_converged;
      return point;
    }
    point.status = PointStatus::ok;
    point.samples = {0.1 + 0.1 * std::pow(std::log2(spec.step / best), 2)};
    return point;
  };
  runners.repeat = [](PointResult& point, const RunLimits&) {
    point.samples.push_back(point.samples.front());
  };
  return runners;
}

TEST(StepSearch, FindsTheFastestStepAndStopsAfterTwoRises) {
  Suite suite = one_family();
  suite.sweeps[0].limits = {0.01};
  std::vector<double> steps;
  const auto outcome = run_sweep(suite, plan(suite, {}), {}, fake(1.0 / 200, 1, &steps));
  const std::vector<double> expected{1.0 / 25,  1.0 / 50,  1.0 / 100,
                                     1.0 / 200, 1.0 / 400, 1.0 / 800};
  ASSERT_EQ(steps.size(), expected.size());
  for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_DOUBLE_EQ(steps[i], expected[i]);
  for (const auto& point : outcome.points)
    EXPECT_EQ(point.best, std::abs(point.spec.step - 1.0 / 200) < 1e-9);
}

// Between the rungs that halve: the best of all steps is found, whichever it is, and no run is made
// twice.
TEST(StepSearch, RefinesTheBestStepByFactorsOfOnePointTwo) {
  Suite suite = one_family();
  suite.sweeps[0].limits = {0.01};
  suite.sweeps[0].refine = true;
  for (const double rate : {100.0, 120.0, 144.0, 168.0, 200.0, 240.0, 288.0, 336.0}) {
    std::vector<double> steps;
    const auto outcome = run_sweep(suite, plan(suite, {}), {}, fake(1 / rate, 1, &steps));
    std::sort(steps.begin(), steps.end());
    EXPECT_EQ(std::adjacent_find(steps.begin(), steps.end()), steps.end()) << rate;
    EXPECT_LE(steps.size(), 14U) << rate;
    for (const auto& point : outcome.points)
      EXPECT_EQ(point.best, std::abs(point.spec.step - 1 / rate) < 1e-9) << rate;
  }
}

TEST(StepSearch, RunsTheWholeLadderWhereAsked) {
  Suite suite = one_family();
  suite.sweeps[0].every_step = true;
  std::vector<double> steps;
  const auto outcome = run_sweep(suite, plan(suite, {}), {}, fake(1.0 / 50, 1.0 / 100, &steps));
  EXPECT_EQ(steps.size(), 18u);  // 1/25 to 1/6400, two limits
  for (const auto& point : outcome.points)
    EXPECT_EQ(point.best, std::abs(point.spec.step - 1.0 / 100) < 1e-9);
}

// Ranks of the median's 95 % confidence interval: standard tables of the sign test (n: 6, 9 and
// 20).
TEST(MedianUncertainty, IsHalfTheIntervalOfTheTabledRanks) {
  const auto first = [](int n) {  // 1, 2, ..., n: the rank is the value
    std::vector<double> samples;
    for (int i = n; i >= 1; --i) samples.push_back(i);
    return samples;
  };
  EXPECT_TRUE(std::isinf(median_uncertainty(first(5))));
  EXPECT_DOUBLE_EQ(median_uncertainty(first(6)), 0.5 * (6 - 1) / 3.5);
  EXPECT_DOUBLE_EQ(median_uncertainty(first(9)), 0.5 * (8 - 2) / 5);
  EXPECT_DOUBLE_EQ(median_uncertainty(first(20)), 0.5 * (15 - 6) / 10.5);
}

TEST(Repetitions, GoOnUntilTheMedianIsKnown) {
  Suite suite = one_family();
  suite.sweeps[0].every_step = true;
  suite.reps = 2;
  suite.most_reps = 30;
  suite.rel_ci = 0.02;
  SweepRunners runners = fake(1.0 / 50, 1, nullptr);
  int count = 0;
  runners.repeat = [&count](PointResult& point, const RunLimits&) {
    const bool steady = point.spec.strain_limit > 0.05;
    point.samples.push_back(point.samples.front() * (steady ? 1 : 1 + 0.5 * (++count % 3)));
  };
  for (const PointResult& point : run_sweep(suite, plan(suite, {}), {}, runners).points) {
    if (point.best) {
      EXPECT_EQ(point.samples.size(), point.spec.strain_limit > 0.05 ? 6u : 30u);
    } else {
      EXPECT_EQ(point.samples.size(), 1u);
    }
  }
}

// Two contestants, one 100 times as fast as the other one: that one is stopped at 30 times, at each
// limit again, and none is called hopeless for it.
TEST(StepSearch, StopsWhoIsFarBehindTheFastestOfAPlace) {
  Suite suite = one_family();
  suite.sweeps[0].contestants = {{"fast_projection", "fast_projection"}, {"jacobi", "jacobi"}};
  SweepRunners runners = fake(1.0 / 200, 1, nullptr);
  std::vector<double> cutoffs;
  runners.run = [inner = runners.run, &cutoffs](const PointSpec& spec, const RunLimits& limits,
                                                std::optional<double> guess) {
    PointResult point = inner(spec, limits, guess);
    if (spec.solver != "jacobi") return point;
    cutoffs.push_back(limits.hopeless);
    point.samples.front() *= 100;
    if (point.samples.front() <= limits.hopeless) return point;
    point.status = PointStatus::timeout;
    point.samples.clear();
    return point;
  };
  const auto outcome = run_sweep(suite, plan(suite, {}), {}, runners);
  ASSERT_EQ(cutoffs.size(), 4u);  // two time-outs end each walk
  for (const double cutoff : cutoffs) EXPECT_NEAR(cutoff, 30 * 0.1, 1e-9);
  for (const auto& point : outcome.points) EXPECT_NE(point.status, PointStatus::skipped);
}

// As with --untimed --steps all: which runs end must not depend on the machine.
TEST(StepSearch, StopsNobodyWhereTimesAreNotUsed) {
  Suite suite = one_family();
  suite.sweeps[0].contestants = {{"fast_projection", "fast_projection"}, {"jacobi", "jacobi"}};
  suite.sweeps[0].every_step = true;
  suite.far_behind = std::numeric_limits<double>::infinity();
  SweepRunners runners = fake(1.0 / 200, 1, nullptr);
  runners.run = [inner = runners.run](const PointSpec& spec, const RunLimits& limits,
                                      std::optional<double> guess) {
    EXPECT_GE(limits.hopeless, 1e300);
    PointResult point = inner(spec, limits, guess);
    if (spec.solver == "jacobi") point.samples.front() *= 1000;
    return point;
  };
  EXPECT_EQ(run_sweep(suite, plan(suite, {}), {}, runners).points.size(), 36u);
}

// A solver is skipped at the next limit only where all of its steps timed out: one that was refused
// at some of them may get through there.
TEST(StepSearch, SkipsATighterLimitOnlyAfterNothingButTimeouts) {
  for (const bool all : {true, false}) {
    const Suite suite = one_family();
    SweepRunners runners = fake(1.0 / 200, 1, nullptr);
    runners.run = [inner = runners.run, all](const PointSpec& spec, const RunLimits& limits,
                                             std::optional<double> guess) {
      PointResult point = inner(spec, limits, guess);
      if (spec.strain_limit < 0.05) return point;
      const bool refused = !all && spec.step > 0.03;
      point.status = refused ? PointStatus::energy_gained : PointStatus::timeout;
      point.samples.clear();
      return point;
    };
    const auto outcome = run_sweep(suite, plan(suite, {}), {}, runners);
    const PointResult& last = outcome.points.back();
    EXPECT_EQ(last.status == PointStatus::skipped, all);
    EXPECT_EQ(std::any_of(outcome.points.begin(), outcome.points.end(),
                          [](const PointResult& p) { return p.ok(); }),
              !all);
  }
}

TEST(StepSearch, GoesFinerThroughFailuresUntilAStepWorks) {
  Suite suite = one_family();
  suite.sweeps[0].limits = {0.01};
  std::vector<double> steps;
  const auto outcome = run_sweep(suite, plan(suite, {}), {}, fake(1.0 / 50, 1.0 / 400, &steps));
  EXPECT_DOUBLE_EQ(steps.back(), 1.0 / 1600);  // best is 1/400, two rises after it
  EXPECT_EQ(std::count_if(outcome.points.begin(), outcome.points.end(),
                          [](const auto& p) { return p.best; }),
            1);
}

TEST(StepSearch, StartsFromTheNeighbourAndLooksBothWays) {
  const Suite suite = one_family();
  std::vector<double> steps;
  const auto outcome = run_sweep(suite, plan(suite, {}), {}, fake(1.0 / 200, 1, &steps));
  // 10 %: six steps as above; 1 %: 1/200 first, then two finer, then two coarser.
  ASSERT_EQ(steps.size(), 11u);
  EXPECT_DOUBLE_EQ(steps[6], 1.0 / 200);
  EXPECT_DOUBLE_EQ(steps[8], 1.0 / 800);
  EXPECT_DOUBLE_EQ(steps[10], 1.0 / 50);
}

TEST(StepSearch, EveryTriedStepStaysInTheOutcomeAndOnlyBestOnesAreRepeated) {
  const Suite suite = one_family();
  const auto outcome = run_sweep(suite, plan(suite, {}), {}, fake(1.0 / 200, 1.0 / 50, nullptr));
  for (const auto& point : outcome.points) {
    EXPECT_EQ(point.samples.size(), point.best ? 3u : point.ok() ? 1u : 0u) << point.spec.id();
  }
}

// First runs say 1/200 s is best; the next ones show that it was luck, and 1/400 s that was not.
TEST(StepSearch, TheBestStepIsChosenByAllSamplesOfThoseThatAreClose) {
  Suite suite = one_family();
  suite.sweeps[0].limits = {0.01};
  suite.reps = 5;
  SweepRunners runners = fake(1.0 / 200, 1, nullptr);
  const auto at = [](const PointSpec& spec, int n) { return std::abs(spec.step * n - 1) < 1e-9; };
  runners.run = [&, run = runners.run](const PointSpec& spec, const RunLimits& limits,
                                       std::optional<double> guess) {
    PointResult point = run(spec, limits, guess);
    if (at(spec, 400)) point.samples = {0.115};
    if (at(spec, 100)) point.samples = {0.2};  // too far to be looked at again
    return point;
  };
  runners.repeat = [&](PointResult& point, const RunLimits&) {
    point.samples.push_back(at(point.spec, 400) ? 0.09 : at(point.spec, 200) ? 0.11 : 0.01);
  };
  const auto outcome = run_sweep(suite, plan(suite, {}), {}, runners);
  for (const PointResult& point : outcome.points) {
    EXPECT_EQ(point.best, at(point.spec, 400)) << point.spec.id();
    const bool close = at(point.spec, 400) || at(point.spec, 200);
    EXPECT_EQ(point.samples.size(), close ? 5u : 1u) << point.spec.id();
  }
}

TEST(StepSearch, SaysWhereTheBestStepIsAnEndOfTheLadder) {
  Suite suite = one_family();
  for (const auto& [best, end] : {std::pair(1.0 / 3, "coarsest"), std::pair(1.0 / 200, ""),
                                  std::pair(1.0 / 50000, "finest")}) {
    suite.sweeps[0].every_step = true;
    for (const PointResult& point :
         run_sweep(suite, plan(suite, {}), {}, fake(best, 1, nullptr)).points)
      EXPECT_EQ(point.at_ladder_end, point.best ? end : "") << point.spec.id();
  }
  suite.sweeps[0].coarsest = suite.sweeps[0].finest = 0.01;  // no ladder has no end
  for (const PointResult& point : run_sweep(suite, plan(suite, {}), {}, fake(1, 1, nullptr)).points)
    EXPECT_EQ(point.at_ladder_end, "");
}

TEST(StepSearch, ASolverThatNeverWorksHasNoBestPoint) {
  const Suite suite = one_family();
  const auto outcome = run_sweep(suite, plan(suite, {}), {}, fake(1.0 / 200, 1e-9, nullptr));
  EXPECT_EQ(outcome.points.size(), 2 * 9u);  // the whole ladder, twice
  for (const auto& point : outcome.points)
    EXPECT_EQ(point.measures.unknown_because, "no run came to an end that could be judged");
  for (const auto& point : outcome.points)
    EXPECT_EQ(point.measures.shape_unknown_because, "no run came to an end that could be judged");
  for (const auto& point : outcome.points) EXPECT_FALSE(point.best);
}

TEST(StepSearch, AnInterruptKeepsWhatWasFinished) {
  const Suite suite = one_family();
  SweepRunners runners = fake(1.0 / 200, 1, nullptr);
  int runs = 0;
  runners.run = [&, run = runners.run](const PointSpec& spec, const RunLimits& limits,
                                       std::optional<double> guess) {
    if (++runs == 4) throw Interrupted();
    return run(spec, limits, guess);
  };
  const auto outcome = run_sweep(suite, plan(suite, {}), {}, runners);
  EXPECT_FALSE(outcome.complete);
  EXPECT_EQ(outcome.points.size(), 3u);
}

TEST(StepSweep, RunsTheWholeLadderAndRepeatsEveryPointThatWorks) {
  Suite suite = one_family();
  suite.sweeps[0].sweep = "step";
  suite.sweeps[0].finest = 1.0 / 3200;
  const auto outcome = run_sweep(suite, plan(suite, {}), {}, fake(1.0 / 200, 1.0 / 50, nullptr));
  EXPECT_EQ(outcome.points.size(), 2 * 8u);
  for (const auto& point : outcome.points) {
    EXPECT_EQ(point.ok(), point.spec.step < 1.0 / 49) << point.spec.id();
    EXPECT_EQ(point.samples.size(), point.ok() ? 3u : 0u) << point.spec.id();
    EXPECT_EQ(point.best, std::abs(point.spec.step - 1.0 / 200) < 1e-9) << point.spec.id();
  }
}

// The error of the fake solver is its step times `slope`; 1 % is 10 times as wrong. The reference
// is exact, or sure to a third of `sure_to`.
SweepRunners erring(SweepRunners runners, double slope, double sure_to = 0) {
  runners.run = [=, run = runners.run](const PointSpec& spec, const RunLimits& limits,
                                       std::optional<double> guess) {
    PointResult point = run(spec, limits, guess);
    const double error = slope * spec.step * (spec.strain_limit < 0.05 ? 10 : 1);
    point.measures.error_series = {{0.5, error, error, sure_to / sure_gaps, 0}};
    return point;
  };
  return runners;
}

bool has_level(const PointResult& point, double level) {
  const auto& levels = point.best_at_errors;
  return std::find(levels.begin(), levels.end(), level) != levels.end();
}

TEST(ErrorLevels, EachHasItsFastestStepBesideTheOneOfAnyMotion) {
  const Suite suite = one_family();
  std::vector<double> steps;
  const auto outcome = run_sweep(suite, plan(suite, {}), {}, erring(fake(1.0 / 100, 1, &steps), 1));
  // At 10 % the error is the step: 1/100 s is right to 1 % and fastest, 1/200 s the coarsest that
  // is to 0.5 %. At 1 % it is ten steps: 1/100 s is right to 10 %, 1/200 s to 5 %, 1/800 s to 2 %,
  // 1/1600 s to 1 %, and 1/3200 s to 0.5 %.
  const std::map<double, double> wanted{
      {0.1, 100}, {0.05, 200}, {0.02, 800}, {0.01, 1600}, {0.005, 3200}};
  for (const PointResult& point : outcome.points) {
    const auto at = [&](double n) { return std::abs(point.spec.step * n - 1) < 1e-9; };
    EXPECT_EQ(point.best, at(100)) << point.spec.id();
    for (const auto& [level, n] : wanted) {
      const double tenth = point.spec.strain_limit > 0.05 ? (level < 0.01 ? 200 : 100) : n;
      EXPECT_EQ(has_level(point, level), at(tenth)) << point.spec.id() << " at " << level;
    }
    // What is near to a best step is looked at again before the search ends.
    const bool best = point.best || !point.best_at_errors.empty();
    EXPECT_TRUE(point.samples.size() == 3u || (!best && point.samples.size() == 1u))
        << point.spec.id();
  }
  // No step is run twice for several levels.
  EXPECT_EQ(steps.size(), outcome.points.size());
}

// The steps that a search of one limit runs, as 1/n s.
std::vector<int> steps_run(Suite suite, const SweepRunners& runners) {
  suite.sweeps[0].limits = {0.1};
  std::vector<int> steps;
  for (const PointResult& point : run_sweep(suite, plan(suite, {}), {}, runners).points)
    steps.push_back(static_cast<int>(std::lround(1 / point.spec.step)));
  return steps;
}

// With a clock by which each halving takes `factor` times as long.
SweepRunners slowing(double factor) {
  SweepRunners runners = fake(1, 1, nullptr);
  runners.run = [=, run = runners.run](const PointSpec& spec, const RunLimits& limits,
                                       std::optional<double> guess) {
    PointResult point = run(spec, limits, guess);
    point.samples = {std::pow(factor, std::log2(0.04 / spec.step))};
    if (point.samples[0] > limits.hopeless) {
      point.status = PointStatus::timeout;
      point.samples.clear();
    }
    return point;
  };
  return runners;
}

TEST(ErrorLevels, TheSearchGoesOnUntilTheFinestIsMet) {
  const Suite suite = one_family();
  // Time rises from the first step on. 0.5 % is reached at 1/800 s: one more step shows that it
  // does not get faster.
  EXPECT_EQ(steps_run(suite, erring(slowing(1.3), 4)),
            (std::vector<int>{25, 50, 100, 200, 400, 800, 1600}));
  // A suite that asks for 2 % alone ends there; without an error to be told, after two rises.
  Suite coarse = suite;
  coarse.finest_error = 0.02;
  EXPECT_EQ(steps_run(coarse, erring(slowing(1.3), 4)), (std::vector<int>{25, 50, 100, 200, 400}));
  EXPECT_EQ(steps_run(suite, slowing(1.3)), (std::vector<int>{25, 50, 100}));
  coarse.finest_error = 1;
  EXPECT_EQ(steps_run(coarse, erring(slowing(1.3), 4)), (std::vector<int>{25, 50, 100}));
  // A reference that is sure to 2 % only has no finer level to be met.
  EXPECT_EQ(steps_run(suite, erring(slowing(1.3), 4, 0.02)),
            (std::vector<int>{25, 50, 100, 200, 400}));
}

TEST(ErrorLevels, TheSearchEndsWhereTimeHasRisenTenfold) {
  const Suite suite = one_family();
  // 1, 1.5, 2.25, 3.4, 5.1, 7.6, 11.4 s: the last is stopped.
  EXPECT_EQ(steps_run(suite, erring(slowing(1.5), 1000)),
            (std::vector<int>{25, 50, 100, 200, 400, 800, 1600}));
  EXPECT_EQ(steps_run(suite, erring(slowing(4), 1000)), (std::vector<int>{25, 50, 100}));
  // A step that meets the next level is not compared with a fast one of a wrong motion: 16 % at 1
  // s, 0.5 % at 243 s.
  EXPECT_EQ(steps_run(suite, erring(slowing(3), 4)),
            (std::vector<int>{25, 50, 100, 200, 400, 800, 1600}));
}

TEST(ErrorLevels, TheSearchEndsWhereTheErrorStaysOrRunsFail) {
  const Suite suite = one_family();
  SweepRunners staying = slowing(1.1);
  staying.run = [run = staying.run](const PointSpec& spec, const RunLimits& limits,
                                    std::optional<double> guess) {
    PointResult point = run(spec, limits, guess);
    const double error = 0.2 + 0.01 * spec.step;  // falls, to what slack leaves
    point.measures.error_series = {{0.5, error, error, 0, 0}};
    return point;
  };
  EXPECT_EQ(steps_run(suite, staying), (std::vector<int>{25, 50, 100}));
  SweepRunners failing = erring(slowing(1.1), 1000);
  failing.run = [run = failing.run](const PointSpec& spec, const RunLimits& limits,
                                    std::optional<double> guess) {
    PointResult point = run(spec, limits, guess);
    if (spec.step < 0.015) point.status = PointStatus::energy_gained;
    return point;
  };
  EXPECT_EQ(steps_run(suite, failing), (std::vector<int>{25, 50, 100, 200}));
}

TEST(ErrorLevels, AnErrorThatIsNotKnownIsNoErrorWithinALevel) {
  const Suite suite = one_family();
  const auto outcome =
      run_sweep(suite, plan(suite, {}), {}, erring(fake(1.0 / 200, 1, nullptr), std::nan("")));
  for (const auto& point : outcome.points) EXPECT_TRUE(point.best_at_errors.empty());
}

TEST(Plan, RefusesFiltersThatLeaveNothing) {
  SweepFilters filters;
  filters.include = Pattern("--filter", "no such point");
  EXPECT_THROW(static_cast<void>(plan(one_family(), filters)), UsageError);
}

// What a wrong suite is told. Each message must name the key or value.
std::string complaint(const std::string& text) {
  const std::string path = ::testing::TempDir() + "suite.json";
  std::ofstream(path) << text;
  try {
    static_cast<void>(read_suite(path));
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Suite, NamesFileKeyAndValueOfWhatIsWrong) {
  const auto sweep = [](const std::string& rest) {
    return complaint(R"({"sweeps": [{"sweep": "strain", "scene": "chain")" + rest + "}]}");
  };
  EXPECT_EQ(sweep(R"(, "limits": [0.1])"), "accepted");
  const auto says = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  says(complaint("{ nonsense"), "is not JSON");
  says(complaint("[]"), "must be an object");
  says(complaint(R"({"reps": 0, "sweeps": []})"), "'reps' is 0");
  says(sweep(R"(, "limits": [0])"), "'limits' is 0");
  says(sweep(R"(, "limits": "all")"), "'limits' is \"all\"");
  says(sweep(R"(, "limit": -1)"), "'limit' is -1");
  says(sweep(R"(, "limits": [0.1], "solver": ["icd"])"), "did you mean 'solvers'");
  says(sweep(R"(, "limits": [0.1], "solvers": ["fast_projetion"])"),
       "did you mean 'fast_projection'");
  says(sweep(R"(, "limits": [0.1], "scene_parameters": {"n": 1})"), "'n' is 1");
  says(sweep(R"(, "limits": [0.1], "scene_parameters": {"m": 1})"),
       "no parameter of scene chain 'm'");
  says(sweep(R"(, "limits": [0.1], "resolutions": [2.5])"), "'resolutions' is 2.5");
  says(sweep(R"(, "limits": [0.1], "solver_options": {"icd": {"max_iteration": 3}})"),
       "did you mean 'max_iterations'");
  says(complaint(R"({"sweeps": [{"sweep": "strain", "scene": "drap", "limits": [1]}]})"),
       "did you mean 'drape'");
}

}  // namespace
}  // namespace harness
