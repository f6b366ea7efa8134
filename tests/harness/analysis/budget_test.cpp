// What methods reach within a frame's time, of a result file whose times are made up.
#include <gtest/gtest.h>

#include "harness/analysis/plane.h"
#include "harness/points/result_file.h"
#include "support/invented_runs.h"

namespace harness::analysis {
namespace {

using invented::document;
using invented::run;
using nlohmann::json;

// A run whose frames take that long; a second of rates must not be mistaken for it.
json framed(json run, double seconds) {
  run["frame_times"] = {{24.0, seconds, 9.0, 9.0}, {frame_rate, 1e-6, seconds, 9.0}};
  return run;
}

std::string reached(const BudgetTable& table, const std::string& row, std::size_t budget) {
  for (const Budgeted& line : table.rows) {
    if (line.row != row) continue;
    const auto& reach = line.reached.at(budget);
    return reach ? reach->point.id().substr(6) : "none";  // without "chain/"
  }
  return "no row";
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
  EXPECT_EQ(reached(table, "yarn_projection", 0), "yarn_projection/n:80/strain:0.1/h:0.01");
  EXPECT_EQ(reached(table, "yarn_projection", 1), "yarn_projection/n:80/strain:0.01/h:0.01");
  EXPECT_EQ(reached(table, "yarn_projection", 2), "yarn_projection/n:80/strain:0.001/h:0.02");
  EXPECT_EQ(reached(table, "icd", 0), "icd_untuned/n:80/strain:0.1/h:0.02");
  EXPECT_EQ(reached(table, "icd", 1), "icd/n:80/strain:0.01/h:0.02");
  EXPECT_EQ(reached(table, "icd", 3), "none") << "no run is that fast";
  EXPECT_FALSE(table.rows[1].reached[1]->right);
  EXPECT_TRUE(table.rows[0].reached[1]->right);
  EXPECT_DOUBLE_EQ(table.rows[0].reached[0]->error, 0.005);
  EXPECT_DOUBLE_EQ(table.rows[0].reached[1]->frame_seconds, 4e-3);
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
