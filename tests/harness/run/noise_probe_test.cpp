// The fixed kernel that tells a noisy machine from a quiet one, with noise of our own making.
#include "harness/run/noise_probe.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace harness {
namespace {

// Keeps this process and its children to the processor that it is on.
void stay_here() {
  cpu_set_t here;
  CPU_ZERO(&here);
  CPU_SET(sched_getcpu(), &here);
  ASSERT_EQ(sched_setaffinity(0, sizeof here, &here), 0);
}

TEST(NoiseProbe, SeesThatOthersTakeTheProcessor) {
  NoiseProbe noise_probe;
  EXPECT_EQ(noise_probe.spread(), 0);
  EXPECT_FALSE(noise_probe.noisy());
  stay_here();
  noise_probe.sample();
  pid_t others[4];
  for (pid_t& other : others) {
    other = fork();
    if (other == 0) {
      for (volatile bool on = true; on;) {
      }
    }
  }
  noise_probe.sample();
  for (const pid_t other : others) {
    kill(other, SIGKILL);
    waitpid(other, nullptr, 0);
  }
  ASSERT_EQ(noise_probe.samples().size(), 2u);
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
