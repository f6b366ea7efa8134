// Interleaved pairs with a fake clock: no process runs here.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "harness/compare/comparison.h"

namespace harness {
namespace {

using nlohmann::json;

ComparedPoint printed(double seconds, const std::string& status = "ok") {
  ComparedPoint point{"strain", "chain", status};
  point.counters = {{"iterations", 10}};
  if (status == "ok") point.samples = {seconds, 2 * seconds};
  return point;
}

Comparison compared(const std::vector<std::string>& names, const RunOne& run) {
  std::vector<PairedPoint> points;
  for (const std::string& name : names) points.push_back({json(name)});
  return compare_in_pairs(std::move(points), 15, 25, {}, {}, run);
}

// A machine whose speed wanders, and now and then drops for a while.
class Machine {
 public:
  explicit Machine(std::uint64_t seed) : random_(seed) {}
  double time(double seconds) {
    drift_ = 0.95 * drift_ + 0.02 * normal_(random_);
    if (busy_ == 0 && random_() % 25 == 0) busy_ = random_() % 10;
    const double load = busy_ > 0 ? (--busy_, 1.8) : 1;
    return seconds * load * std::exp(drift_ + 0.01 * std::abs(normal_(random_)));
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double drift_ = 0;
  std::uint64_t busy_ = 0;
};

TEST(CompareInPairs, SidesTakeTurnsInComingFirst) {
  std::string order;
  compared({"a", "b"}, [&order](Side side, const PairedPoint& point) {
    order += (side == Side::old_one ? "A" : "B") + point.spec.get<std::string>() + " ";
    return printed(1);
  });
  EXPECT_TRUE(order.starts_with("Aa Ba Ab Bb Ba Aa Bb Ab Aa Ba Ab Bb ")) << order;
}

TEST(CompareInPairs, APointThatFailedIsNotRunAgain) {
  int runs = 0;
  const auto comparison = compared({"a"}, [&runs](Side side, const PairedPoint&) {
    const bool fails = side == Side::new_one && ++runs > 1;  // a later process
    return printed(1, fails ? "crashed" : "ok");
  });
  EXPECT_EQ(runs, 2);
  EXPECT_EQ(comparison.points[0].change, Change::newly_failing);
}

TEST(CompareInPairs, IdenticalProgramsPassOnAnUneasyMachine) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Machine machine(seed);
    const auto comparison =
        compared({"a", "b", "c"}, [&](auto&&...) { return printed(machine.time(1)); });
    EXPECT_FALSE(comparison.any(is_regression)) << "seed " << seed;
  }
}

TEST(CompareInPairs, FindsWhatHasBecomeSlowerByAFifth) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Machine machine(seed);
    const auto comparison = compared({"a", "b"}, [&](Side side, const PairedPoint& point) {
      return printed(machine.time(side == Side::new_one && point.spec == "b" ? 1.2 : 1.0));
    });
    EXPECT_TRUE(comparison.points[0].change == Change::same ||
                comparison.points[0].change == Change::ambiguous);
    found += comparison.points[1].change == Change::slower;
  }
  EXPECT_GE(found, 45);
}

// Slow in the first look only, as under another program's load.
TEST(CompareInPairs, TimesFoundOnceOnlyAreNoRegression) {
  int runs = 0;
  const auto comparison = compared({"a"}, [&runs](Side side, const PairedPoint&) {
    const bool slow = side == Side::new_one && runs < 30;
    return printed((slow ? 1.2 : 1.0) + 1e-4 * (++runs % 7));
  });
  EXPECT_EQ(runs, 30 + 50);
  EXPECT_EQ(comparison.points[0].change, Change::ambiguous);
  EXPECT_NE(comparison.points[0].text().find("SLOWER at first, but not in another 25 pairs"),
            std::string::npos)
      << comparison.points[0].text();
}

// On a machine so busy that a test of 15 pairs may miss it.
TEST(CompareInPairs, ADoubledTimeIsNeverTheSame) {
  std::mt19937_64 random(1);
  std::lognormal_distribution<double> noise(0, 1.5);
  for (int trial = 0; trial < 20; ++trial) {
    const PointChange point = compared({"a"}, [&](Side side, const PairedPoint&) {
                                return printed((side == Side::new_one ? 2 : 1) * noise(random));
                              }).points[0];
    EXPECT_NE(point.change, Change::same);
    EXPECT_EQ(point.undecided, point.change == Change::ambiguous);
  }
}

TEST(CompareInPairs, WhatFailsOnBothSidesIsUndecidedAndWhatFailsBeforeOnlyIsFixed) {
  for (const std::string status : {"crashed", "timeout", "diverged"}) {
    const auto both = compared({"a"}, [&](auto&&...) { return printed(1, status); });
    EXPECT_EQ(both.points[0].change, Change::ambiguous) << status;
    EXPECT_TRUE(both.undecided()) << status;
    const auto old_alone = compared({"a"}, [&](Side side, const PairedPoint&) {
      return printed(1, side == Side::old_one ? status : "ok");
    });
    EXPECT_EQ(old_alone.points[0].change, Change::fixed) << status;
  }
}

}  // namespace
}  // namespace harness
