// Which of some measured runs to take: planted times, errors and frames.
#include "harness/run/choose.h"

#include <gtest/gtest.h>

namespace harness {
namespace {

PointResult run(const std::string& solver, double step, double seconds, double error) {
  PointResult point;
  point.spec.solver = solver;
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

TEST(Choose, TheFastestIsThatWithinTheError) {
  EXPECT_EQ(fastest(measured_runs, {.error = 0.02})->point, &measured_runs[1]);
  EXPECT_EQ(fastest(measured_runs, {.error = 0.02}, "a")->point, &measured_runs[2]);
  EXPECT_EQ(fastest(measured_runs, {.error = any_motion})->point, &measured_runs[0]);
  EXPECT_FALSE(fastest(measured_runs, {.error = 0.001}));
  EXPECT_FALSE(fastest(measured_runs, {.error = 0.02, .rate = 30})) << "no frames of that rate";
}

TEST(Choose, WhatABudgetBuysIsTheLeastErrorOfThoseThatKeepIt) {
  EXPECT_EQ(most_accurate(measured_runs, {}, 7.0 / 60)->point, &measured_runs[2]);
  EXPECT_EQ(most_accurate(measured_runs, {}, 5.0 / 60)->point, &measured_runs[1])
      << "99 % of frames, not the median";
  EXPECT_EQ(most_accurate(measured_runs, {}, 1)->point, &measured_runs[3]);
  EXPECT_FALSE(most_accurate(measured_runs, {}, 1.0 / 60));
}

TEST(Choose, WhatFailedIsNoChoice) {
  std::vector<PointResult> all = measured_runs;
  all[1].status = PointStatus::strain_missed;
  EXPECT_EQ(fastest(all, {.error = 0.02})->point->spec.solver, "b");
}

}  // namespace
}  // namespace harness
