// The rank test against scipy's numbers; changes and gates; pairs with a fake clock.
#include "harness/compare/comparison.h"

#include <cmath>
#include <random>

#include "harness/base/statistics.h"
#include "support/refusal.h"

namespace harness {
namespace {

using Times = std::vector<double>;

TEST(MannWhitney, AgreesWithIndependentPrograms) {
  const auto series = [](int from, int to, auto value) {
    Times times;
    for (int i = from; i < to; ++i) times.push_back(value(i));
    return times;
  };
  const Times tied_a{3, 4, 2, 6, 2, 5, 7, 7}, tied_b{9, 7, 5, 10, 6, 8, 2, 3};
  const Times many_a = series(3, 43, [](int i) { return i % 17; });
  const Times many_b = series(0, 45, [](int i) { return (3 * i % 19) * 0.9; });
  struct Row {
    Times a, b;
    double p, accuracy;
  };
  for (const Row& row :
       {// scipy 1.10.1: scipy.stats.mannwhitneyu(a, b, alternative="greater", method="exact")
        Row{{0.8, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46},
            {1.15, 0.88, 0.9, 0.74, 1.21},
            0.1272061272061272,
            1e-15},
        // ties: all choices of ranks counted one by one (scipy.stats.rankdata and
        // itertools.combinations)
        Row{tied_a, tied_b, 0.9120435120435121, 1e-15},
        Row{tied_b, tied_a, 0.10240870240870241, 1e-15},
        // many: method="asymptotic", which corrects for ties and continuity
        Row{many_a, many_b, 0.6717825771992799, 1e-9}})
    EXPECT_NEAR(mann_whitney_greater(row.a, row.b), row.p, row.accuracy);
}

Times spread(double middle, int n, double width = 0.01) {
  Times times;
  for (int i = 0; i < n; ++i) times.push_back(middle * (1 + width * (i % 5)));
  return times;
}

TEST(CompareTimes, FlagsOnlyWhatTestAndBothRatiosAgreeOn) {
  const Times base = spread(1, 15);
  Times one_fast = spread(1.15, 15);
  one_fast.front() = 1;
  struct Row {
    Times base, next;
    Change change;
    const char* reason;
  };
  for (const auto& [before, after, change, reason] :
       {Row{base, spread(1.15, 15), Change::slower, ""},
        Row{spread(1.15, 15), base, Change::faster, ""},
        Row{base, spread(1.02, 15), Change::same, ""},  // sure, but small
        Row{base, base, Change::same, ""},
        Row{base, one_fast, Change::ambiguous, "only the median"},
        Row{{1, 1.01, 1.02}, {2, 2.1, 2.2}, Change::ambiguous, "it takes 4 each"},
        Row{{1, 1.01, 1.02, 1.03}, {2, 2.1, 2.2, 2.3}, Change::slower, ""},
        Row{{1}, {1.01}, Change::same, ""}, Row{{}, {1.01}, Change::same, ""}}) {
    const TimeChange times = compare_times(before, after, Gate());
    EXPECT_EQ(times.change, change) << times.reason;
    EXPECT_NE(times.reason.find(reason), std::string::npos) << times.reason;
    EXPECT_EQ(times.too_few, before.size() == 3);
  }
}

ComparedPoint point_with(const std::string& id, double iterations = 100) {
  return {.sweep = "strain",
          .id = id,
          .status = "ok",
          .spec = "same",
          .counters = {{"iterations", iterations}, {"steps", 50}},
          .errors = {{"max_strain", 0.009}, {"trajectory", 0.02}}};
}

ComparedResult result_of(std::vector<ComparedPoint> points) {
  ComparedResult result;
  result.path = "result.json";
  result.context = {{"counters_fingerprint", "c"}, {"cpu_model", "cpu"}, {"num_cpus", 2}};
  result.points = std::move(points);
  return result;
}

const char* const some_id = "chain/shake/n:80/strain:0.01/h:0.01";

TEST(Compare, JudgesAPoint) {
  struct Row {
    const char *before, *after;  // statuses
    double iterations;           // 100 before
    CounterRule rule;
    double error_before, error_after;
    Change change;
  };
  using enum CounterRule;
  for (const Row& row : {Row{"ok", "ok", 100, exact, 0.02, 0.02, Change::same},
                         Row{"ok", "diverged", 100, exact, 0.02, 0.02, Change::newly_failing},
                         Row{"diverged", "ok", 100, exact, 0.02, 0.02, Change::fixed},
                         Row{"diverged", "diverged", 100, exact, 0.02, 0.02, Change::same},
                         Row{"diverged", "singular", 100, exact, 0.02, 0.02, Change::ambiguous},
                         Row{"timeout", "crashed", 200, exact, 0.02, 0.02, Change::same},
                         Row{"ok", "ok", 101, exact, 0.02, 0.02, Change::slower},
                         Row{"ok", "ok", 99, exact, 0.02, 0.02, Change::changed},
                         Row{"ok", "ok", 101, rise, 0.02, 0.02, Change::slower},
                         Row{"ok", "ok", 99, rise, 0.02, 0.02, Change::faster},
                         Row{"ok", "ok", 101, inform, 0.02, 0.02, Change::same},
                         Row{"ok", "ok", 100, exact, 0.02, 0.0201, Change::same},
                         Row{"ok", "ok", 100, exact, 0.02, 0.021, Change::changed},
                         Row{"ok", "ok", 100, exact, 1e-16, 3e-16, Change::same},  // rounding
                         Row{"ok", "ok", 100, exact, 0.02, 0.01, Change::same}}) {
    ComparedPoint base = point_with(some_id), next = point_with(some_id, row.iterations);
    base.status = row.before;
    next.status = row.after;
    base.errors["trajectory"] = row.error_before;
    next.errors["trajectory"] = row.error_after;
    Gate gate;
    gate.counter_rule = row.rule;
    const PointChange judged = compare(result_of({base}), result_of({next}), gate).points.at(0);
    EXPECT_EQ(judged.change, row.change)
        << row.before << " -> " << row.after << ": " << judged.text();
  }
  Gate steps;
  steps.counters = {"steps"};
  const auto same_steps =
      compare(result_of({point_with(some_id)}), result_of({point_with(some_id, 101)}), steps);
  EXPECT_EQ(same_steps.count(Change::same), 1u);
}

TEST(Compare, LeavesCountersOfAnotherBuildAndTimesOfAnotherMachineAlone) {
  ComparedPoint base = point_with(some_id), next = point_with(some_id, 101);
  base.samples = spread(1, 15);
  next.samples = spread(2, 15);
  ComparedResult here = result_of({base}), there = result_of({next});
  there.context["counters_fingerprint"] = "another";
  const Comparison times_only = compare(here, there, Gate());
  EXPECT_EQ(times_only.points[0].change, Change::slower);
  EXPECT_EQ(times_only.points[0].text().find("iterations"), std::string::npos);
  there.context["cpu_model"] = "another";
  EXPECT_THROW(compare(here, there, Gate()), NotComparable);
  there.context["counters_fingerprint"] = "c";
  const Comparison counters_only = compare(here, there, Gate());
  EXPECT_EQ(counters_only.points[0].text(), "iterations 100 -> 101 (+1 %)");
  ComparedResult untimed = here;
  untimed.context["timed"] = false;
  EXPECT_TRUE(comparability(here, here, {}).times());
  EXPECT_FALSE(comparability(here, untimed, {}).times() ||
               comparability(untimed, here, {}).times());
}

TEST(Compare, ASearchMayTakeAnotherWay) {
  std::vector<ComparedPoint> base{point_with("chain/icd/n:80/strain:0.01/h:0.02"),
                                  point_with("chain/icd/n:80/strain:0.01/h:0.01"),
                                  point_with("chain/icd/n:80/strain:0.01/h:0.005")};
  for (ComparedPoint& point : base) point.searched = true;
  std::vector<ComparedPoint> next{base[0], base[1]};
  next[0].status = "timeout";  // three times the best one's time
  next[1].best = true;
  const Comparison comparison = compare(result_of(base), result_of(next), Gate());
  ASSERT_EQ(comparison.points.size(), 1u);
  EXPECT_EQ(comparison.points[0].change, Change::same);
  for (ComparedPoint& point : base) point.searched = false;
  for (ComparedPoint& point : next) point.searched = false;
  const Comparison whole = compare(result_of(base), result_of(next), Gate());
  EXPECT_EQ(whole.count(Change::newly_failing), 1u);
  EXPECT_EQ(whole.count(Change::missing), 1u);
}

TEST(Compare, PairsPointsOfOneNameInTheirOrder) {
  const auto both = result_of({point_with(some_id, 1), point_with(some_id, 2)});
  EXPECT_EQ(compare(both, both, Gate()).count(Change::same), 2u);
}

TEST(Gate, IsReadAndRefusedByName) {
  for (const auto& [text, part] :
       {std::pair("{", "'g.json' is not JSON"),
        {R"({"counters": {"names": ["iteration"]}})", "[names][0], \"iteration\": "},
        {R"({"errors": {"maxstrain": 2}})", "at [errors]: unknown key 'maxstrain'"}})
    EXPECT_TRUE(refuses([&text = text] { parse_gate(text, "g.json"); }, part)) << text;
  const Gate gate = parse_gate(
      R"({"times": {"count": false}, "counters": {"rule": "rise", "names": ["steps"]}, "errors": {}})",
      "g.json");
  EXPECT_FALSE(gate.times);
  EXPECT_EQ(gate.counter_rule, CounterRule::rise);
  EXPECT_TRUE(gate.errors.empty());
}

// ---- Interleaved pairs ----

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
struct Machine {
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
