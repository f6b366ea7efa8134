// Steps of known length and time, cut into frames.
#include "harness/run/frame_times.h"

#include <gtest/gtest.h>

namespace harness {
namespace {

TEST(FrameTimes, AddUpTheStepsThatEndInAFrame) {
  FrameTimes frames(1.0 / 120);
  for (int i = 1; i <= 240; ++i)  // two seconds; the 100th step is slow
    frames.add(1, 1.0 / 120, i / 120.0, i == 100 ? 1.0 : 0.001);
  const std::vector<FrameTime> rates = frames.summary();
  ASSERT_EQ(rates.size(), 3u);
  const double steps[] = {5, 4, 2};  // a frame
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rates[i].rate, 120 / steps[i]);
    EXPECT_NEAR(rates[i].median, 0.001 * steps[i], 1e-12);
    EXPECT_NEAR(rates[i].worst, 1 + 0.001 * (steps[i] - 1), 1e-12);
    EXPECT_LE(rates[i].slow, rates[i].worst);
    EXPECT_GE(rates[i].slow, rates[i].median);
  }
}

TEST(FrameTimes, OfStepsThatAreTimedTogetherAreThoseOfEachAlone) {
  FrameTimes one(1.0 / 1000), blocks(1.0 / 1000);
  for (int i = 1; i <= 1000; ++i) one.add(1, 1.0 / 1000, i / 1000.0, 0.002);
  for (int i = 40; i <= 1000; i += 40) blocks.add(40, 1.0 / 1000, i / 1000.0, 0.08);
  const auto a = one.summary(), b = blocks.summary();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(a[i].median, b[i].median, 1e-12);
    EXPECT_NEAR(a[i].worst, b[i].worst, 1e-12);
  }
}

TEST(FrameTimes, OfPartsOfAFrameAndOfFramesShorterThanAStepAreLeftOut) {
  FrameTimes coarse(1.0 / 25);
  for (int i = 1; i <= 25; ++i) coarse.add(1, 1.0 / 25, i / 25.0, 0.5);
  ASSERT_EQ(coarse.summary().size(), 1u);
  EXPECT_EQ(coarse.summary()[0].rate, 24);
  FrameTimes cut(0.01);
  for (int i = 1; i <= 5; ++i) cut.add(1, 0.01, 0.01 * i, i == 5 ? 9.0 : 0.5);  // 1.2 frames
  EXPECT_EQ(cut.summary()[0].worst, 2);
  FrameTimes none(0.01);
  none.add(1, 0.01, 0.01, 1);
  EXPECT_TRUE(none.summary().empty());
}

}  // namespace
}  // namespace harness
