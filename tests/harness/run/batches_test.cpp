// Samples of real runs: of short ones a sample is the mean of a batch.
#include <gtest/gtest.h>

#include "harness/points/point_json.h"
#include "harness/run/measure_point.h"

namespace harness {
namespace {

PointSpec short_chain(double step) {
  PointSpec spec;
  spec.sweep = "strain";
  spec.scene = "chain";
  spec.scene_parameters = complete_parameters(*find_scene("chain"), {{"n", 10}});
  spec.resolution = spec.vertices = 10;
  spec.constraints = 9;
  spec.solver = "gauss_seidel";
  spec.step = step;
  return spec;
}

TEST(Batches, ASampleOfAShortRunTakesAtLeastTwentyMilliseconds) {
  PointResult point = run_point(short_chain(0.01), {});
  ASSERT_TRUE(point.ok()) << point.detail;
  for (int i = 1; i < 4; ++i) repeat_point(point, {});
  ASSERT_EQ(point.samples.size(), 4u);
  ASSERT_EQ(point.sample_runs.size(), 4u);
  ASSERT_EQ(point.cpu_samples.size(), 4u);
  ASSERT_EQ(point.filter_samples.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const double a_run = point.samples[i] * point.spec.step * point.steps_planned;
    EXPECT_GE(a_run * point.sample_runs[i], least_sample * (1 - 1e-9));
    EXPECT_GT(point.cpu_samples[i], 0);
  }
  EXPECT_GE(point.measured_seconds(), 4 * least_sample * (1 - 1e-9));
  EXPECT_EQ(point.seconds(), *std::min_element(point.samples.begin(), point.samples.end()));
}

TEST(Batches, ProcessorTimeIsNoMoreThanWallTime) {
  const PointResult point = run_point(short_chain(0.001), {});
  ASSERT_TRUE(point.ok()) << point.detail;
  // Reads of the clock between blocks of steps are part of it, and not of the wall time.
  EXPECT_LT(point.cpu_samples[0], 1.5 * point.samples[0]);
}

TEST(Batches, WithoutAReaderOfTimesOneRunIsASample) {
  RunLimits limits;
  limits.timed = false;
  PointResult point = run_point(short_chain(0.01), limits);
  repeat_point(point, limits);
  EXPECT_EQ(point.sample_runs, (std::vector<int>{1, 1}));
  EXPECT_EQ(point.retaken, 0);
}

TEST(Batches, WorkIsThatOfOneRunHoweverManyASampleHas) {
  RunLimits untimed;
  untimed.timed = false;
  EXPECT_EQ(run_point(short_chain(0.01), {}).work, run_point(short_chain(0.01), untimed).work);
}

}  // namespace
}  // namespace harness
