// Whether a garment holds.
#include <gtest/gtest.h>

#include "harness/claims/judging.h"
#include "support/invented_points.h"

namespace harness {
namespace {

using nlohmann::json;

json worn(const std::string& solver, double limit, double rim, double across) {
  json p = point("garment", "strain", solver, limit, 1664, 0.01, 1);
  p["scene_parameters"]["drop"] = 0.2;
  p["sag"] = {{"rim", rim}, {"rim_across", across}};
  p["rest_speed"] = 0.1;
  return p;
}

TEST(Claims, C16WantsTheRimAboveTheHipsAtOnePercentAndBelowThemAtTen) {
  const auto both = [](const std::string& solver, double loose, double tight) {
    return std::vector<json>{worn(solver, 0.1, loose, loose), worn(solver, 0.01, tight, tight)};
  };
  std::vector<json> points = both("fast_projection", 0.5, 0.1);
  EXPECT_EQ(verdict("C16", points).verdict, "reproduced");
  EXPECT_TRUE(says(verdict("C16", points), "fast projection 50 % at 1 %, 250 % at 10 %"));
  EXPECT_EQ(verdict("C16", both("icd", 0.1, 0.1)).verdict, "not reproduced");
  EXPECT_EQ(verdict("C16", both("icd", 0.5, 0.3)).verdict, "not reproduced");
  for (const json& p : both("icd", 0.19, 0.1)) points.push_back(p);
  EXPECT_EQ(verdict("C16", points).verdict, "changed");
  EXPECT_EQ(verdict("C16", both("yarn_projection", 0.5, 0.1)).verdict, "not yet measured")
      << "who is not the paper's does not count";
}

// One side on the hips and one past them is neither.
TEST(Claims, C16AsksBothEndsOfTheRim) {
  EXPECT_EQ(verdict("C16", {worn("icd", 0.1, 0.5, 0.15), worn("icd", 0.01, 0.1, 0.1)}).verdict,
            "not reproduced");
}

}  // namespace
}  // namespace harness
