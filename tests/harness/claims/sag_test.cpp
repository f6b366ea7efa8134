// Claim C12 and the figure that it is compared with.
#include <gtest/gtest.h>

#include <cmath>

#include "harness/claims/judging.h"
#include "support/invented_points.h"

namespace harness {
namespace {

TEST(ParabolaSag, HasAnArcLongerByTheStrain) {
  for (const double strain : {0.5, 0.1, 0.01, 1e-4}) {
    for (const double length : {1.0, 3.0}) {
      const double sag = claims::parabola_sag(length, strain);
      const auto height = [=](double s) { return -4 * sag * s * (1 - s); };
      constexpr int parts = 20000;
      double arc = 0;
      for (int i = 0; i < parts; ++i) {
        const double from = static_cast<double>(i) / parts, to = from + 1.0 / parts;
        arc += std::hypot(length / parts, height(to) - height(from));
      }
      EXPECT_NEAR(arc / length, 1 + strain, 1e-6 * strain + 1e-9);
    }
  }
  EXPECT_NEAR(claims::parabola_sag(1, 1e-8) / std::sqrt(3e-8 / 8), 1, 1e-3);
}

json hung(const std::string& solver, double limit, double lower_edge) {
  json p = point("hung_patch", "strain", solver, limit, 961, 0.01, 1);
  p["scene_parameters"]["side"] = 2;
  p["sag"] = {{"top_row", 0.5 * lower_edge}, {"lower_edge", lower_edge}};
  p["rest_speed"] = 0.1;
  return p;
}

TEST(Claims, C12HoldsTheLowerEdgesSagAgainstOnePercentOfTheSide) {
  const auto all = [](const std::string& solver, double loose, double middle, double tight) {
    return std::vector<json>{hung(solver, 0.1, loose), hung(solver, 0.01, middle),
                             hung(solver, 0.001, tight)};
  };
  std::vector<json> points = all("jacobi", 0.3, 0.1, 0.05);
  EXPECT_EQ(verdict("C12", points).verdict, "reproduced");
  EXPECT_TRUE(says(verdict("C12", points), "10 % and 2.5 % of the side with Jacobi"));
  EXPECT_EQ(verdict("C12", all("jacobi", 0.3, 0.1, 0.09)).verdict, "not reproduced");
  for (const json& p : all("fast_projection", 0.05, 0.05, 0.05)) points.push_back(p);
  EXPECT_EQ(verdict("C12", points).verdict, "changed");
  // Who is not the paper's does not count.
  EXPECT_EQ(verdict("C12", all("yarn_projection", 0.3, 0.1, 0.05)).verdict, "not yet measured");
}

}  // namespace
}  // namespace harness
