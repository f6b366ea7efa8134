// Which samples are taken again, and what tells a noisy machine from a quiet one, with noise of our
// own making.
#include "harness/run/machine_noise.h"

#include <gtest/gtest.h>

#include <vector>

namespace harness {
namespace {

// Samples are 1, 2, 3, ... and looks take what a list says, in ms; the first ten are quiet ones.
TEST(QuietSamples, ADisturbedLookOnEitherSideTakesItAgainUpToThreeTimes) {
  struct Row {
    const char* what;
    std::vector<double> looks;
    int dropped, sample, retaken;
  };
  for (const auto& [what, looks, dropped, sample, retaken] :
       {Row{"before", {1.06, 1.0, 1.0}, 0, 2, 1},
        Row{"after, which is before the next one, too", {1.0, 1.06, 1.0, 1.0}, 0, 3, 2},
        Row{"the calmest stands, between 1.2 and 1.3", {2.0, 1.5, 1.2, 1.3, 3.0}, 0, 3, 3},
        Row{"one was dropped before", {2.0, 1.5, 1.2, 1.3}, 1, 3, 3}}) {
    int samples = 0, warm = 0;
    std::size_t seen = 0;
    QuietProbe probe([&, &list = looks] { return ++warm <= 10 ? 1e-3 : 1e-3 * list.at(seen++); });
    const auto quiet = take_quietly(
        probe, [&] { return ++samples; }, [](int) { return true; }, dropped);
    EXPECT_EQ(quiet.sample, sample) << what;
    EXPECT_EQ(quiet.retaken, retaken) << what;
    EXPECT_EQ(seen, looks.size()) << what;
  }
}

TEST(QuietSamples, NoMoreThanAQuarterOfAllAreTakenAgain) {
  RetakeBudget budget;
  EXPECT_EQ(budget.most(), QuietProbe::most_retaken);
  budget.add(100, 45);
  EXPECT_EQ(budget.most(), QuietProbe::most_retaken);
  budget.add(1, 3);
  EXPECT_EQ(budget.most(), 0);
  budget.add(100, 0);
  EXPECT_EQ(budget.most(), QuietProbe::most_retaken);
}

TEST(QuietSamples, WhatIsUsualIsLearntAnew) {
  double now = 1;
  QuietProbe probe([&now] { return now; });
  probe.look();
  now = 1.2;
  EXPECT_TRUE(probe.disturbed(probe.look()));
  probe.renew(1.2);
  EXPECT_FALSE(probe.disturbed(probe.look())) << "nothing was renewed before";
  probe.renew(1.0);
  EXPECT_TRUE(probe.disturbed(probe.look()));
  probe.renew(1.2);
  EXPECT_TRUE(probe.disturbed(probe.look())) << "the one before the last counts, too";
  probe.renew(1.2);
  EXPECT_FALSE(probe.disturbed(probe.look()));
}

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
