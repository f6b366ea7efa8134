// Findings from invented times: sentences, known exponents, and budgets.
#include "harness/analysis/findings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "harness/points/result_file.h"
#include "support/invented_runs.h"

namespace harness::analysis {
namespace {

using invented::document;
using invented::run;
using nlohmann::json;

TEST(Findings, NameTheFirstItsPriceAndTheBestOfThePaper) {
  json failed = run("yarn_projection", 0.01, 0.01, 0.05, 0.3);
  failed["status"] = "diverged";
  struct Row {
    std::vector<json> runs;
    std::string sentence;  // or a part of it
  };
  for (const auto& [runs, sentence] : {
           Row{{run("yarn_projection", 0.01, 0.01, 0.05, 0.014), run("icd", 0.01, 0.005, 0.2, 0.01),
                run("shake", 0.01, 0.01, 0.1, 0.012)},
               "At 1 % strain, motion error at most 2 %, yarn_projection is the fastest: 49.8 ms a "
               "simulated second with steps of 1/100 s and an error of 1.4 %; shake, the best of "
               "the paper's six, takes 2.00 (1.99-2.01) times as long."},
           Row{{run("yarn_projection", 0.01, 0.01, 0.0500, 0.01),
                run("icd", 0.01, 0.01, 0.0501, 0.01), run("shake", 0.01, 0.01, 0.1, 0.01)},
               "yarn_projection and icd are the fastest, too close to rank: 49.8 ms a simulated "
               "second with steps of 1/100 s and an error of 1 %; shake, the next, takes 2.0"},
           // No run has an error of at most 2 %: the nearest looser level is answered.
           Row{{run("yarn_projection", 0.01, 0.01, 0.05, 0.04), run("icd", 0.01, 0.01, 0.1, 0.3)},
               "At 1 % strain, motion error at most 5 %, only yarn_projection has a run"},
           Row{{run("yarn_projection", 0.01, 0.01, 0.05, 0.3)},
               "At 1 % strain, whatever the motion, "},
           Row{{failed},
               "At 1 % strain, whatever the motion, there is no answer: no run keeps the strain "
               "limit."},
       }) {
    const auto findings = findings_of(planes_of(document(runs)));
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_NE(findings[0].sentences.at(0).find(sentence), std::string::npos)
        << findings[0].sentences[0];
  }
}

// Some 95 % of 95 % intervals hold the truth. Fewer than 360 of 400 do with a chance below 1e-4.
TEST(Slope, IntervalsHoldTheTruthAsOftenAsTheySay) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.1);
  int inside = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<double> sizes, seconds;
    for (const double n : {101, 201, 317, 501, 1001}) {
      sizes.push_back(n);
      seconds.push_back(std::exp(noise(random)) * 1e-7 * std::pow(n, 1.1));
    }
    const Slope slope = log_log_slope(sizes, seconds);
    inside += slope.low() <= 1.1 && 1.1 <= slope.high();
  }
  EXPECT_GE(inside, 360);
  EXPECT_LT(inside, 400);
}

// ---- Budgets ----

// The median, and the times at another rate, must not be mistaken for `seconds`.
json framed(json run, double seconds) {
  run["frame_times"] = {{24.0, seconds, 9.0, 9.0}, {frame_rate, 1e-6, seconds, 9.0}};
  return run;
}

TEST(Budget, HoldsTheTightestStrainWhoseMotionIsRightWithinAFrame) {
  const json first = document({
      framed(run("yarn_projection", 0.1, 0.02, 1, 0.01), 0.8e-3),
      framed(run("yarn_projection", 0.1, 0.01, 2, 0.005), 0.9e-3),  // the same limit, less error
      framed(run("yarn_projection", 0.01, 0.02, 3, 0.03), 0.9e-3),  // its motion is wrong
      framed(run("yarn_projection", 0.01, 0.01, 3, 0.01), 4e-3),    // at the budget itself
      framed(run("icd", 0.1, 0.02, 1, 0.03), 2e-3),                 // never right: its least error
      framed(run("icd", 0.01, 0.02, 1, 0.025), 3e-3),               //
      framed(run("icd_untuned", 0.1, 0.02, 1, 0.05), 1e-3),         // in icd's row
      framed(run("null", 0.01, 0.02, 1, 0), 1e-6),                  // does not compete
  });
  json failed = framed(run("shake", 0.001, 0.02, 1, 0.001), 1e-3);
  failed["status"] = "strain_missed";
  json bare = run("jacobi", 0.1, 0.02, 1, 0.001);  // no frames were timed
  bare["frame_times"] = json::array();
  const json second =
      document({failed, bare, framed(run("yarn_projection", 0.001, 0.02, 1, 0.01), 16e-3)});
  const json pieces = joined({first, second});
  const auto tables = budget_tables(pieces, {1e-3, 4e-3, 16e-3, 0.5e-3});
  ASSERT_EQ(tables.size(), 1u) << "two pieces of one scene and size";
  const BudgetTable& table = tables.front();
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].row, "yarn_projection") << "the tightest strain comes first";
  EXPECT_EQ(table.rows[1].row, "icd");
  const auto &yarns = table.rows[0].reached, &icd = table.rows[1].reached;
  EXPECT_EQ(yarns.at(0)->point.id(), "chain/yarn_projection/n:80/strain:0.1/h:0.01");
  EXPECT_EQ(yarns.at(1)->point.id(), "chain/yarn_projection/n:80/strain:0.01/h:0.01");
  EXPECT_EQ(yarns.at(2)->point.id(), "chain/yarn_projection/n:80/strain:0.001/h:0.02");
  EXPECT_EQ(icd.at(0)->point.id(), "chain/icd_untuned/n:80/strain:0.1/h:0.02");
  EXPECT_EQ(icd.at(1)->point.id(), "chain/icd/n:80/strain:0.01/h:0.02");
  EXPECT_FALSE(icd.at(3)) << "no run is that fast";
  EXPECT_FALSE(icd.at(1)->right);
  EXPECT_TRUE(yarns.at(1)->right);
  EXPECT_DOUBLE_EQ(yarns.at(0)->error, 0.005);
  EXPECT_DOUBLE_EQ(yarns.at(1)->frame_seconds, 4e-3);
}

TEST(Budget, ClimbsStairsOfRunsThatReachMoreThanAllFasterOnes) {
  const json result = document({
      framed(run("yarn_projection", 0.1, 0.02, 1, 0.01), 2e-3),
      framed(run("yarn_projection", 0.1, 0.01, 2, 0.02), 3e-3),   // more error at the same limit
      framed(run("yarn_projection", 0.01, 0.01, 2, 0.01), 4e-3),  // less strain
      framed(run("yarn_projection", 0.1, 0.04, 1, 0.5), 1e-3),    // wrong, but the first
      framed(run("yarn_projection", 0.001, 0.01, 2, 0.3), 5e-3),  // wrong, where others are right
  });
  const auto tables = budget_tables(result, {});
  ASSERT_EQ(tables.at(0).rows.size(), 1u);
  std::vector<double> frames;
  for (const Reach& reach : tables[0].rows[0].stairs) frames.push_back(reach.frame_seconds);
  EXPECT_EQ(frames, (std::vector<double>{1e-3, 2e-3, 4e-3}));
}

}  // namespace
}  // namespace harness::analysis
