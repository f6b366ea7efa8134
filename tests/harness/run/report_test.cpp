// What a sweep prints at its end: how time grows with size.
#include "harness/run/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "harness/run/growth.h"

namespace harness {
namespace {

PointResult best_point(const std::string& solver, int n, double seconds_a_step) {
  PointResult point;
  point.spec.sweep = "resolution";
  point.spec.scene = "drape";
  point.spec.solver = solver;
  point.spec.resolution = n;
  point.spec.vertices = n * n;
  point.spec.step = 0.001;
  point.status = PointStatus::ok;
  point.best = true;
  point.steps_planned = 10;
  point.work.steps = 10;
  point.samples = {seconds_a_step / 0.001};
  return point;
}

std::vector<const PointResult*> pointers(const std::vector<PointResult>& points) {
  std::vector<const PointResult*> all;
  for (const PointResult& point : points) all.push_back(&point);
  return all;
}

TEST(Growth, RecoversAKnownExponent) {
  std::vector<PointResult> points;
  for (const int n : {1001, 101, 317})
    points.push_back(best_point("a", n, 3e-7 * std::pow(n * n, 1.25)));
  const auto found = growths(pointers(points));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].exponent.value, 1.25, 1e-12);
  EXPECT_LT(found[0].exponent.half_width, 1e-6);
  EXPECT_EQ(found[0].smallest->spec.resolution, 101);
  EXPECT_EQ(found[0].largest->spec.resolution, 1001);
}

// Of 95 % intervals, some 95 % hold the truth: of 400, fewer than 360 with a chance below 1e-4.
TEST(Growth, IntervalsHoldTheTruthAsOftenAsTheySay) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.1);
  int inside = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<PointResult> points;
    for (const int n : {101, 201, 317, 501, 1001})
      points.push_back(best_point("a", n, std::exp(noise(random)) * 1e-7 * std::pow(n * n, 1.1)));
    const Slope slope = growths(pointers(points)).at(0).exponent;
    inside += slope.low() <= 1.1 && 1.1 <= slope.high();
  }
  EXPECT_GE(inside, 360);
  EXPECT_LT(inside, 400);
}

TEST(Growth, LeavesOutFailuresAndSolversWithOneSize) {
  std::vector<PointResult> points;
  for (const int n : {101, 201, 317}) points.push_back(best_point("a", n, 1e-6 * n * n));
  points.push_back(best_point("a", 1001, 1));
  points.back().status = PointStatus::timeout;
  points.push_back(best_point("b", 101, 1));
  const auto found = growths(pointers(points));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].exponent.points, 3);
  EXPECT_NEAR(found[0].exponent.value, 1, 1e-12);
  std::ostringstream out;
  print_table(out, points);
  EXPECT_NE(out.str().find("exponent"), std::string::npos);
  EXPECT_NE(out.str().find("10201..100489"), std::string::npos);
}

}  // namespace
}  // namespace harness
