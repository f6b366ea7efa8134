// The fixed kernel that tells a noisy machine from a quiet one, with noise of our own making.
#include "harness/run/noise_probe.h"

#include <gtest/gtest.h>

namespace harness {
namespace {

// Others take the processor every tenth time, for a turn of some milliseconds.
TEST(NoiseProbe, SeesThatOthersTakeTheProcessor) {
  bool shared = false;
  int turn = 0;
  NoiseProbe noise_probe(60, [&] { return shared && ++turn % 10 == 0 ? 5e-3 : 1e-3; });
  EXPECT_EQ(noise_probe.spread(), 0);
  EXPECT_FALSE(noise_probe.noisy());
  noise_probe.sample();
  noise_probe.sample();
  EXPECT_FALSE(noise_probe.noisy());
  shared = true;
  noise_probe.sample();
  ASSERT_EQ(noise_probe.samples().size(), 3u);
  EXPECT_TRUE(noise_probe.noisy()) << "spread " << noise_probe.spread();
  EXPECT_TRUE(noise_probe.to_json().at("noisy").get<bool>());
}

TEST(NoiseProbe, TakesTimeForItsOwnWork) { EXPECT_GT(fixed_work(), 0); }

TEST(NoiseProbe, SamplesWhenItIsDue) {
  NoiseProbe seldom(3600), always(0);
  for (int i = 0; i < 3; ++i) {
    seldom.sample_if_due();
    always.sample_if_due();
  }
  EXPECT_EQ(seldom.samples().size(), 1u);
  EXPECT_EQ(always.samples().size(), 3u);
}

TEST(ProcessorTicks, GoOnAndGiveAShare) {
  const ProcessorTicks before = processor_ticks();
  EXPECT_GT(before.all, 0);
  EXPECT_DOUBLE_EQ(stolen_share({1, 10}, {2, 14}), 0.25);
  EXPECT_DOUBLE_EQ(stolen_share(before, before), 0);
}

}  // namespace
}  // namespace harness
