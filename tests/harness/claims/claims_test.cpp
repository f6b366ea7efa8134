// Verdicts on the paper's claims follow from points by the stated rules: invented points in, known
// verdicts out.
#include "harness/claims/claims.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace harness {
namespace {

using nlohmann::json;

json point(const std::string& scene, const std::string& sweep, const std::string& solver,
           double limit, int vertices, double step, double seconds) {
  std::ostringstream id;
  id << scene << "/" << solver << "/n:" << vertices << "/strain:" << limit << "/h:" << step;
  return {{"id", id.str()},
          {"scene", scene},
          {"sweep", sweep},
          {"solver", solver},
          {"status", "ok"},
          {"best", true},
          {"strain_limit", limit},
          {"vertices", vertices},
          {"step", step},
          {"duration", 1.0},
          {"options", json::object()},
          {"scene_parameters", {{"mass", 1.0}, {"gravity", 9.81}}},
          {"error", json::object()},
          {"work", {{"steps", std::lround(1 / step)}, {"iterations", 2 * std::lround(1 / step)}}},
          {"seconds_per_simulated_second", {{"median", seconds}}},
          {"max_strain_after_collision", nullptr}};
}

json document(const std::vector<json>& points) { return {{"points", points}}; }

ClaimVerdict verdict(const std::string& id, const std::vector<json>& points) {
  const auto claims = judge_claims({document(points)});
  const auto found =
      std::find_if(claims.begin(), claims.end(), [&](const auto& c) { return c.id == id; });
  EXPECT_NE(found, claims.end());
  return *found;
}

// Time falls off as limit^exponent.
void strain_curve(std::vector<json>& points, const std::string& scene, const std::string& solver,
                  double at_ten_percent, double exponent, double step = 0.01) {
  for (const double limit : {0.1, 0.03, 0.01, 0.003, 0.001})
    points.push_back(point(scene, "strain", solver, limit, 80, step,
                           at_ten_percent * std::pow(limit / 0.1, exponent)));
}

TEST(Claims, AreSixteenAndUndecidedWithoutPoints) {
  const auto claims = judge_claims({document({})});
  ASSERT_EQ(claims.size(), 16u);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    EXPECT_EQ(claims[i].id, "C" + std::to_string(i + 1));
    EXPECT_EQ(claims[i].verdict, "not yet measured");
    EXPECT_TRUE(claims[i].points.empty());
  }
}

TEST(Claims, C1ComparesSlopesAndGivesThemWithTheirRatios) {
  std::vector<json> points;
  strain_curve(points, "chain", "implicit_springs", 1, -0.5);
  strain_curve(points, "chain", "fast_projection", 0.1, -0.1);
  const ClaimVerdict steeper = verdict("C1", points);
  EXPECT_EQ(steeper.verdict, "reproduced");
  EXPECT_NE(steeper.measured.find("implicit springs -0.5"), std::string::npos) << steeper.measured;
  EXPECT_NE(steeper.measured.find("ratio 10 at 10 %, 63.1 at 0.1 %"), std::string::npos)
      << steeper.measured;
  EXPECT_EQ(steeper.points.size(), 10u);

  points.clear();
  strain_curve(points, "chain", "implicit_springs", 1, -0.1);
  strain_curve(points, "chain", "fast_projection", 0.1, -0.5);
  EXPECT_EQ(verdict("C1", points).verdict, "not reproduced");

  // Steeper, but so noisy that the intervals overlap.
  points.clear();
  strain_curve(points, "chain", "implicit_springs", 1, -0.3);
  strain_curve(points, "chain", "fast_projection", 0.1, -0.2);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i]["seconds_per_simulated_second"]["median"] =
        points[i]["seconds_per_simulated_second"]["median"].get<double>() * (i % 2 ? 1.6 : 0.6);
  EXPECT_EQ(verdict("C1", points).verdict, "changed");
}

TEST(Claims, C2NeedsASmallerExponentOverVertices) {
  const auto with = [](double springs, double fast) {
    std::vector<json> points;
    for (const int n : {20, 40, 80, 160}) {
      points.push_back(point("chain", "resolution", "implicit_springs", 0.01, n, 0.01,
                             std::pow(n / 20.0, springs)));
      points.push_back(
          point("chain", "resolution", "fast_projection", 0.01, n, 0.01, std::pow(n / 20.0, fast)));
    }
    return verdict("C2", points).verdict;
  };
  EXPECT_EQ(with(2, 1), "reproduced");
  EXPECT_EQ(with(1, 2), "not reproduced");
}

TEST(Claims, C3TakesTheRatioAtOnePercentApart) {
  const auto with = [](double ratio) {
    return verdict("C3",
                   {point("chain", "strain", "implicit_springs", 0.01, 80, 0.01, ratio * 1e-3),
                    point("chain", "strain", "fast_projection", 0.01, 80, 0.01, 1e-3)});
  };
  EXPECT_EQ(with(25).verdict, "reproduced");
  EXPECT_EQ(with(5).verdict, "changed");
  EXPECT_EQ(with(100).verdict, "changed");
  EXPECT_EQ(with(0.9).verdict, "not reproduced");
  EXPECT_NE(with(25).measured.find("100 steps of 2 iterations"), std::string::npos)
      << with(25).measured;
}

TEST(Claims, C5AsksForFlatSlopesAndTheFirstPlaceForFastProjection) {
  const auto with = [](double shake_time) {
    std::vector<json> points;
    strain_curve(points, "drape", "jacobi", 1, -0.8);
    strain_curve(points, "drape", "gauss_seidel", 0.8, -0.8);
    strain_curve(points, "drape", "shake", shake_time, -0.1);
    strain_curve(points, "drape", "icd", 3, -0.1);
    strain_curve(points, "drape", "fast_projection", 1.5, -0.1);
    return verdict("C5", points);
  };
  EXPECT_EQ(with(2).verdict, "reproduced");
  EXPECT_NE(with(2).measured.find("ahead of strain limiting from 3 % down"), std::string::npos)
      << with(2).measured;
  EXPECT_EQ(with(1).verdict, "changed");
}

TEST(Claims, C6LooksAtEverySize) {
  const auto with = [](double small, double large) {
    std::vector<json> points;
    for (const auto& [n, seconds] : {std::pair(100, small), std::pair(400, large)}) {
      points.push_back(point("drape", "resolution", "fast_projection", 0.01, n, 0.01, seconds));
      points.push_back(point("drape", "resolution", "gauss_seidel", 0.01, n, 0.01, 1.0));
    }
    return verdict("C6", points).verdict;
  };
  EXPECT_EQ(with(0.5, 0.5), "reproduced");
  EXPECT_EQ(with(1.5, 0.5), "changed");
  EXPECT_EQ(with(0.5, 1.5), "not reproduced");
}

TEST(Claims, C7FitsTheOrderOfTheResidualAtTheTightestLimit) {
  const auto with = [](double order, double last_over_first) {
    std::vector<json> points;
    for (const double step : {0.01, 0.005, 0.0025, 0.00125, 0.000625}) {
      for (const double limit : {0.1, 0.001}) {
        json p = point("chain", "step", "fast_projection", limit, 80, step, 1);
        const double first = limit > 0.01 ? 1e-3 : std::pow(step, order);
        p["error"] = {{"residual_first", first}, {"residual_last", last_over_first * first}};
        points.push_back(p);
      }
    }
    return verdict("C7", points);
  };
  EXPECT_EQ(with(2, 0.9).verdict, "reproduced");
  EXPECT_EQ(with(4, 0.9).verdict, "reproduced");
  EXPECT_EQ(with(1, 0.9).verdict, "changed");
  EXPECT_EQ(with(1, 1.5).verdict, "not reproduced");
  EXPECT_EQ(with(2, 0.9).points.size(), 4u);
}

TEST(Claims, C11ComparesNonzerosOfFactorsOfOneSize) {
  const auto with = [](double icd, double fast, const char* linear_solver = "quasi_definite") {
    json a = point("drape", "strain", "icd", 0.01, 441, 0.01, 1);
    a["options"]["linear_solver"] = linear_solver;
    json b = point("drape", "strain", "fast_projection", 0.01, 441, 0.01, 1);
    a["work"]["factor_nonzeros"] = icd;
    b["work"]["factor_nonzeros"] = fast;
    return verdict("C11", {a, b}).verdict;
  };
  EXPECT_EQ(with(3000, 1000), "reproduced");
  EXPECT_EQ(with(1000, 3000), "not reproduced");
  EXPECT_EQ(with(3000, 1000, "projected_cg"), "not yet measured");  // not ICD's own matrix
}

TEST(Claims, C13HoldsTheStrainAfterCollisionAgainstTheLimit) {
  const auto with = [](double after) {
    json p = point("drape", "strain", "fast_projection", 0.001, 441, 0.01, 1);
    p["max_strain_after_collision"] = after;
    return verdict("C13", {p}).verdict;
  };
  EXPECT_EQ(with(0.0012), "reproduced");
  EXPECT_EQ(with(0.008), "changed");
  EXPECT_EQ(with(0.05), "not reproduced");
}

TEST(Claims, C15AsksForSmallerAndCheaperSteps) {
  const auto with = [](double shake_step, double shake_seconds) {
    return verdict("C15", {point("chain", "strain", "shake", 0.01, 80, shake_step, shake_seconds),
                           point("chain", "strain", "icd", 0.01, 80, 0.01, 1)})
        .verdict;
  };
  EXPECT_EQ(with(0.001, 2), "reproduced");
  EXPECT_EQ(with(0.001, 20), "not reproduced");  // small, but dear
  EXPECT_EQ(with(0.02, 0.1), "not reproduced");
}

TEST(Claims, FailuresAndPointsThatAreNotBestDoNotCount) {
  json slow = point("chain", "strain", "implicit_springs", 0.01, 80, 0.02, 0.001);
  slow["best"] = false;
  json failed = point("chain", "strain", "fast_projection", 0.01, 80, 0.02, 0.1);
  failed["status"] = "not_converged";
  const ClaimVerdict c3 = verdict(
      "C3", {slow, failed, point("chain", "strain", "implicit_springs", 0.01, 80, 0.01, 0.5),
             point("chain", "strain", "fast_projection", 0.01, 80, 0.01, 0.02)});
  EXPECT_EQ(c3.verdict, "reproduced");
}

TEST(Claims, OfTwoDocumentsTheFirstThatHasAPointCounts) {
  const auto pair = [](double ratio) {
    return document({point("chain", "strain", "implicit_springs", 0.01, 80, 0.01, ratio),
                     point("chain", "strain", "fast_projection", 0.01, 80, 0.01, 1)});
  };
  EXPECT_EQ(judge_claims({pair(25), pair(1)})[2].verdict, "reproduced");
  EXPECT_EQ(judge_claims({pair(1), pair(25)})[2].verdict, "not reproduced");
}

TEST(Claims, OfTwoSizesTheLargerCountsAndAdaptiveStepsDoNot) {
  std::vector<json> points{point("chain", "strain", "implicit_springs", 0.01, 80, 0.01, 25),
                           point("chain", "strain", "fast_projection", 0.01, 80, 0.01, 1),
                           point("chain", "strain", "implicit_springs", 0.01, 20, 0.01, 1),
                           point("chain", "strain", "fast_projection", 0.01, 20, 0.01, 1)};
  EXPECT_EQ(verdict("C3", points).verdict, "reproduced");
  json adaptive = point("chain", "strain", "fast_projection", 0.01, 80, 0.02, 25);
  adaptive["adaptive"] = true;
  points.insert(points.begin(), adaptive);
  EXPECT_EQ(verdict("C3", points).verdict, "reproduced");
}

TEST(Claims, MarkdownHasOneRowAClaim) {
  std::ostringstream out;
  print_claims_markdown(out, judge_claims({document({})}));
  const std::string table = out.str();
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2 + 16);
}

}  // namespace
}  // namespace harness
