// Samples that are taken again, with a machine and samples of our own making.
#include "harness/run/quiet_samples.h"

#include <gtest/gtest.h>

#include <vector>

namespace harness {
namespace {

// A probe whose looks take what a list says, in ms; the first ten are quiet ones.
class ListedLooks {
 public:
  explicit ListedLooks(std::vector<double> looks)
      : looks_(std::move(looks)), probe_([this] { return next(); }) {}
  QuietProbe& probe() { return probe_; }
  std::size_t seen() const { return seen_; }

 private:
  double next() {
    if (warm_ < 10) return ++warm_, 1e-3;
    return 1e-3 * looks_.at(seen_++);
  }
  std::vector<double> looks_;
  std::size_t seen_ = 0;
  int warm_ = 0;
  QuietProbe probe_;
};

struct Outcome {
  int sample, retaken;
  std::size_t looks;
};

// Samples are 1, 2, 3, ...
Outcome take(std::vector<double> looks, int may_be_retaken = 100, int retaken = 0) {
  ListedLooks listed(std::move(looks));
  int samples = 0;
  const auto quiet = take_quietly(
      listed.probe(), [&] { return ++samples; },
      [&](int sample) { return sample <= may_be_retaken; }, retaken);
  return {quiet.sample, quiet.retaken, listed.seen()};
}

TEST(QuietSamples, ADisturbedLookOnEitherSideTakesItAgain) {
  EXPECT_EQ(take({1.06, 1.0, 1.0}).sample, 2) << "before";
  EXPECT_EQ(take({1.0, 1.06, 1.0, 1.0}).sample, 3) << "after, which is before the next one, too";
  EXPECT_EQ(take({1.0, 1.06, 1.0, 1.0}).retaken, 2);
}

TEST(QuietSamples, AtMostThreeTimesAndThenTheCalmestStands) {
  const Outcome outcome = take({2.0, 1.5, 1.2, 1.3, 3.0});
  EXPECT_EQ(outcome.sample, 3);  // between 1.2 and 1.3
  EXPECT_EQ(outcome.retaken, QuietProbe::most_retaken);
  EXPECT_EQ(outcome.looks, 5u);
  EXPECT_EQ(take({2.0, 1.5, 1.2, 1.3}, 100, 1).retaken, 3) << "one was dropped before";
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

}  // namespace
}  // namespace harness
