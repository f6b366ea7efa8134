// Interleaved pairs with a fake clock: no process runs here.
#include "harness/compare/pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace harness {
namespace {

using nlohmann::json;

json printed(const std::string& id, double seconds, const std::string& status = "ok",
             double iterations = 10) {
  json point = {{"sweep", "strain"},
                {"id", id},
                {"status", status},
                {"status_detail", ""},
                {"spec", "same"},
                {"work", {{"iterations", iterations}}},
                {"max_strain", 0.01},
                {"error", json::object()},
                {"seconds_per_simulated_second", nullptr}};
  if (status == "ok")
    point["seconds_per_simulated_second"] = {{"min", seconds}, {"samples", {seconds, 2 * seconds}}};
  return point;
}

std::vector<PairedPoint> points_named(std::initializer_list<const char*> ids) {
  std::vector<PairedPoint> points;
  for (const char* id : ids) points.push_back({json::object(), id, 1, {}, {}});
  return points;
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

Gate informing() {
  Gate gate;
  gate.counter_rule = CounterRule::inform;
  return gate;
}

TEST(RunPairs, TakesTurnsInComingFirst) {
  auto points = points_named({"a", "b"});
  std::string order;
  run_pairs({&points[0], &points[1]}, 3, [&order](Side side, const PairedPoint& point) {
    order += (side == Side::old_one ? "A" : "B") + point.id + " ";
    return printed(point.id, 1);
  });
  EXPECT_EQ(order, "Aa Ba Ab Bb Ba Aa Bb Ab Aa Ba Ab Bb ");
  EXPECT_EQ(points[0].before.samples.size(), 3u);
  EXPECT_EQ(points[1].after.samples, (std::vector<double>{1, 1, 1}));  // the least of each process
}

TEST(RunPairs, LeavesAPointThatFailedAlone) {
  auto points = points_named({"a"});
  int runs = 0;
  run_pairs({&points[0]}, 5, [&runs](Side side, const PairedPoint& point) {
    ++runs;
    const bool fails = side == Side::new_one && runs > 2;  // a later process, not the first
    return printed(point.id, 1, fails ? "crashed" : "ok");
  });
  EXPECT_EQ(runs, 3);
  EXPECT_TRUE(points[0].before.ok());
  EXPECT_EQ(points[0].after.status, "crashed");
}

TEST(CompareInPairs, IdenticalProgramsPassOnAnUneasyMachine) {
  int flagged = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Machine machine(seed);
    const auto comparison = compare_in_pairs(
        points_named({"a", "b", "c"}), 15, 25, informing(), {},
        [&machine](Side, const PairedPoint& point) { return printed(point.id, machine.time(1)); });
    if (comparison.any(is_regression)) {
      ++flagged;
      std::cout << "seed " << seed << " flagged\n";
    }
  }
  EXPECT_EQ(flagged, 0);
}

TEST(CompareInPairs, FindsWhatHasBecomeSlowerByAFifth) {
  int found = 0, others = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Machine machine(seed);
    const auto comparison =
        compare_in_pairs(points_named({"a", "b"}), 15, 25, informing(), {},
                         [&machine](Side side, const PairedPoint& point) {
                           const bool slow = side == Side::new_one && point.id == "b";
                           return printed(point.id, machine.time(slow ? 1.2 : 1.0));
                         });
    others += comparison.points[0].change != Change::same &&
              comparison.points[0].change != Change::ambiguous;
    found += comparison.points[1].change == Change::slower;
  }
  EXPECT_GE(found, 45);
  EXPECT_EQ(others, 0);
}

// Slow in the first look only, as a neighbour's load would have it.
TEST(CompareInPairs, TimesFoundOnceOnlyAreNoRegression) {
  int runs = 0;
  const auto comparison = compare_in_pairs(
      points_named({"a"}), 15, 25, informing(), {}, [&runs](Side side, const PairedPoint& point) {
        const bool slow = side == Side::new_one && runs < 30;
        return printed(point.id, (slow ? 1.2 : 1.0) + 1e-4 * (++runs % 7));
      });
  EXPECT_EQ(runs, 30 + 50);
  EXPECT_EQ(comparison.points[0].change, Change::ambiguous);
  EXPECT_NE(comparison.points[0].text().find("SLOWER at first, but not in another 25 pairs"),
            std::string::npos)
      << comparison.points[0].text();
}

// A machine so busy that no test of 15 pairs finds a doubled time.
TEST(CompareInPairs, ADoubledTimeIsNeverTheSame) {
  std::mt19937_64 random(1);
  std::lognormal_distribution<double> noise(0, 1.5);
  for (int trial = 0; trial < 20; ++trial) {
    const auto comparison = compare_in_pairs(
        points_named({"a"}), 15, 25, informing(), {}, [&](Side side, const PairedPoint& point) {
          return printed(point.id, (side == Side::new_one ? 2 : 1) * noise(random));
        });
    EXPECT_NE(comparison.points[0].change, Change::same);
    if (comparison.points[0].change == Change::ambiguous) {
      EXPECT_TRUE(comparison.points[0].undecided);
    }
  }
}

TEST(CompareInPairs, EqualTimesOnAQuietMachineAreTheSame) {
  int runs = 0;
  const auto comparison = compare_in_pairs(points_named({"a"}), 15, 25, informing(), {},
                                           [&runs](Side, const PairedPoint& point) {
                                             return printed(point.id, 1 + 1e-3 * (++runs % 7));
                                           });
  EXPECT_EQ(comparison.points[0].change, Change::same) << comparison.points[0].text();
}

TEST(CompareInPairs, WhatFailsOnBothSidesIsUndecidedAndWhatFailsBeforeOnlyIsFixed) {
  for (const std::string status : {"crashed", "timeout", "diverged"}) {
    const auto both = compare_in_pairs(
        points_named({"a"}), 4, 4, informing(), {},
        [&](Side, const PairedPoint& point) { return printed(point.id, 1, status); });
    EXPECT_EQ(both.points[0].change, Change::ambiguous) << status;
    EXPECT_TRUE(both.undecided()) << status;
    const auto old_alone = compare_in_pairs(
        points_named({"a"}), 4, 4, informing(), {}, [&](Side side, const PairedPoint& point) {
          return printed(point.id, 1, side == Side::old_one ? status : "ok");
        });
    EXPECT_EQ(old_alone.points[0].change, Change::fixed) << status;
  }
}

TEST(CompareInPairs, CountersInformUnlessTheGateSaysOtherwise) {
  const RunOne more_work = [](Side side, const PairedPoint& point) {
    return printed(point.id, 1, "ok", side == Side::old_one ? 10 : 11);
  };
  const auto told = compare_in_pairs(points_named({"a"}), 4, 4, informing(), {}, more_work);
  EXPECT_EQ(told.points[0].change, Change::same);
  EXPECT_EQ(told.points[0].text(), "iterations 10 -> 11 (+10 %)");
  const auto failed = compare_in_pairs(points_named({"a"}), 4, 4, Gate(), {}, more_work);
  EXPECT_EQ(failed.points[0].change, Change::slower);
}

TEST(SamplesFor, MeasuresShortRunsOften) {
  EXPECT_EQ(samples_for(0.0005, 0.03), 60);
  EXPECT_EQ(samples_for(1, 0.03), 1);
  EXPECT_EQ(samples_for(0, 0.03), 1000);
}

}  // namespace
}  // namespace harness
