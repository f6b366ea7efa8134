// Choosing from runs with given times and errors, with a clock that only invented runs advance.
#include "harness/run/choose.h"

#include <gtest/gtest.h>

#include "harness/run/fake_machine.h"

namespace harness {
namespace {

PointResult run(const std::string& solver, double step, double seconds, double error) {
  PointResult point;
  point.spec.contestant = point.spec.solver = solver;
  point.spec.step = step;
  point.status = PointStatus::ok;
  point.samples = {seconds};
  point.frame_times = {{60, seconds / 60, 2 * seconds / 60, 3 * seconds / 60}};
  point.measures.trajectory = error;
  point.measures.gap = 1e-6;
  point.measures.error_samples = 5;
  return point;
}

const std::vector<PointResult> measured_runs{
    run("a", 1.0 / 60, 1, 0.05), run("a", 1.0 / 120, 2, 0.015), run("b", 1.0 / 60, 3, 0.01),
    run("b", 1.0 / 240, 8, 0.002)};

TEST(Choose, PicksTheFastestWithinTheError) {
  EXPECT_EQ(fastest(measured_runs, {.error = 0.02})->point, &measured_runs[1]);
  EXPECT_EQ(fastest(measured_runs, {.error = 0.02}, "a")->point, &measured_runs[2]);
  EXPECT_EQ(fastest(measured_runs, {.error = any_motion})->point, &measured_runs[0]);
  EXPECT_FALSE(fastest(measured_runs, {.error = 0.001}));
  EXPECT_FALSE(fastest(measured_runs, {.error = 0.02, .rate = 30})) << "no frames of that rate";
}

TEST(Choose, FramesKeepTheBudgetNotTheirMean) {
  std::vector<PointResult> all = measured_runs;  // frames of "b": 3 / 60 s, 99 % below 6 / 60 s
  all[1].frame_times = {{60, 2.0 / 60, 9.0 / 60, 9.0 / 60}};
  const struct {
    double budget;     // in 1/60 s
    std::size_t best;  // the fastest, or the fastest of those that keep it
    Kept kept;
  } rows[] = {{0, 1, Kept::nearly_all},
              {6.5, 2, Kept::nearly_all},
              {2.5, 1, Kept::half},
              {1.5, 1, Kept::fewer}};
  for (const auto& row : rows) {
    const Recommendation found = recommend(all, {.budget = row.budget / 60});
    EXPECT_EQ(found.best->point, &all[row.best]) << row.budget;
    EXPECT_EQ(found.budget, row.kept) << row.budget;
    EXPECT_EQ(found.all_is_well(), row.kept == Kept::nearly_all) << row.budget;
    EXPECT_EQ(found.to_be_taken(), row.kept != Kept::fewer) << "median above " << row.budget;
    EXPECT_TRUE(row.best != 2 || found.next->point == &all[1]);
  }
  EXPECT_FALSE(recommend(all, {.error = 0.001}).to_be_taken());
}

TEST(Choose, LaddersFollowWhatScreeningSaw) {
  std::vector<PointResult> screened;
  for (const auto& [status, seconds] : std::vector<std::pair<PointStatus, std::vector<double>>>{
           {PointStatus::unsupported, {}},
           {PointStatus::strain_missed, {0.1}},
           {PointStatus::ok, {3}},
           {PointStatus::not_converged, {0.01}},
           {PointStatus::ok, {2}},
           {PointStatus::timeout, {}}})
    screened.emplace_back(PointSpec{}, status).samples = seconds;
  EXPECT_EQ(ladder_order(screened), (std::vector<std::size_t>{4, 2, 1, 3, 0, 5}));
}

// Six contestants on a chain: seconds at 1/60 s, twice as many at half the step. The error is 1 %.
struct InventedMachine {
  std::map<std::string, double> seconds{
      {"fast_projection", 5},        {"jacobi", 40}, {"gauss_seidel", 30},
      {"yarn_projection@bdf2", 0.2}, {"icd", 20},    {"implicit_springs", 10}};
  std::vector<std::string> calls;  // "screen icd", "run icd", "repeat icd"
  double clock = 0;                // s
  double interrupt_at = 1e300;
  double latest = 0;  // s: when the last run ended or was stopped

  Trials choose(double for_seconds) {
    Suite suite = suite_of_chain({0.01});
    suite.reps = 1;
    suite.far_behind = 4;
    SweepSpec& sweep = suite.sweeps.front();
    sweep.contestants.clear();
    for (const auto& [name, s] : seconds) sweep.contestants.push_back({name, name});
    std::ranges::reverse(sweep.contestants);
    sweep.coarsest = 1.0 / 60;
    sweep.finest = 1.0 / 240;
    const auto take = [this](const PointSpec& spec, const RunLimits& limits) {
      calls.push_back((limits.look        ? "screen "
                       : limits.sample_of ? "repeat "
                                          : "run ") +
                      spec.solver);
      EXPECT_TRUE(!limits.look || limits.hopeless <= 0.1);
      const double cost = seconds.at(spec.solver) / (60 * spec.step);
      const double busy = limits.look ? limits.hopeless : std::min(cost, limits.hopeless);
      // Time passes in small pieces, and a run asks after each whether it is to stop.
      for (double spent = 0; spent < busy; spent += 0.01) {
        latest = clock += 0.01;
        if (limits.interrupted()) throw Interrupted();
      }
      PointResult point = run(spec.solver, spec.step, cost, 0.01);
      point.spec = spec;
      if (busy < cost && calls.back().starts_with("run")) point.status = PointStatus::timeout;
      return point;
    };
    return try_contestants(
        suite, plan(suite, {}), {},
        {for_seconds, [this] { return clock; }, [this] { return clock >= interrupt_at; }}, {},
        take);
  }
};

TEST(Choose, ScreensAllBeforeTheFirstLadderAndFindsTheFastestWhateverTheOrderOfTheList) {
  InventedMachine machine;
  const Trials trials = machine.choose(60);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_TRUE(machine.calls[i].starts_with("screen")) << machine.calls[i];
  EXPECT_EQ(machine.calls[6], "run yarn_projection@bdf2") << "the fastest when screened";
  const Recommendation found = recommend(trials.points, {});
  ASSERT_TRUE(found.best);
  EXPECT_EQ(found.best->point->spec.solver, "yarn_projection@bdf2");
  EXPECT_EQ(found.best->point->samples.size(), 9u) << "sampled again at the end";
}

TEST(Choose, StopsARunInProgressWhenTheTimeIsOverAndDropsNoContestantWithoutAReason) {
  for (const double seconds : {0.3, 1.0, 6.0, 20.0, 60.0}) {
    InventedMachine machine;
    machine.seconds["yarn_projection@bdf2"] = 3;
    const Trials trials = machine.choose(seconds);
    EXPECT_LE(machine.latest, 1.02 * seconds + 0.01);
    EXPECT_EQ(trials.screened.size(), 6u);
    EXPECT_EQ(recommend(trials.points, {}).best.has_value(), seconds > 5);
    EXPECT_FALSE(trials.complete);
    for (const auto& [name, s] : machine.seconds) {
      const std::string why = why_not(name, trials, {});
      const bool has_run = std::ranges::any_of(trials.points, [&, n = name](const PointResult& p) {
        return p.ok() && p.spec.solver == n;
      });
      EXPECT_EQ(why.empty(), has_run) << name << " in " << seconds << " s: " << why;
    }
  }
}

// At whatever moment: no answer, which might be a false one.
TEST(Choose, AnInterruptionIsNoAnswer) {
  InventedMachine whole;
  whole.choose(20);
  for (double at = 0; at < whole.latest; at += 0.17) {
    InventedMachine machine;
    machine.interrupt_at = at;
    EXPECT_THROW(machine.choose(20), Interrupted) << at;
    EXPECT_LE(machine.latest, at + 0.011) << "and at once";
  }
}

}  // namespace
}  // namespace harness
