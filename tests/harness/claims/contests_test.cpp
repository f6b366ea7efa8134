// Claims on which method is fast: verdicts only where intervals lie on one side.
#include <gtest/gtest.h>

#include <cmath>

#include "support/invented_points.h"

namespace harness {
namespace {

TEST(Claims, RatiosAreWrittenWithAsManyDigitsAsTheirIntervalsHave) {
  EXPECT_EQ(claims::text(Ratio{3.52, 3.31, 3.78}), "3.5 (3.3-3.8)");
  EXPECT_EQ(claims::text(Ratio{1.04, 0.953, 1.16}), "1.04 (0.95-1.16)");  // not 1.0
  EXPECT_EQ(claims::text(Ratio{1.0004, 0.9971, 1.0042}), "1.000 (0.997-1.004)");
  EXPECT_EQ(claims::text(Ratio{.value = 3.52}), "3.5 (?)");
  EXPECT_EQ(claims::text(Ratio{}), "?");
}

TEST(Claims, C1ComparesSlopesAtEqualStrain) {
  const auto with = [](double springs, double fast, double noise = 0) {
    std::vector<json> points;
    strain_curve(points, "chain", "implicit_springs", 1, springs);
    strain_curve(points, "chain", "fast_projection", 0.1, fast);
    return verdict("C1", points, noise);
  };
  const ClaimVerdict steeper = with(-0.5, -0.1);
  EXPECT_EQ(steeper.verdict, "reproduced");
  EXPECT_TRUE(says(steeper, "fast projection's -0.4"));
  EXPECT_TRUE(says(steeper, "ratio 63.1 (62.9-63.3) at 0.1 %, ratio 10.00 (9.97-10.03) at 10 %"));
  EXPECT_TRUE(says(steeper, "over the error at any limit: not yet measured"));
  EXPECT_EQ(steeper.points.size(), 10u);
  EXPECT_EQ(with(-0.1, -0.5).verdict, "not reproduced");
  // A slope of -0.1 over two decades is a factor of 1.6: not beyond a noise of 1.6.
  EXPECT_EQ(with(-0.2, -0.1, 0.01).verdict, "reproduced");
  EXPECT_EQ(with(-0.2, -0.1, 0.5).verdict, "undecided");
}

// The project's question decides; the paper's, and time against error, stand beside it.
TEST(Claims, C1TellsOfEqualErrorToo) {
  const auto with = [](double springs_error, double gap = 1e-9) {
    std::vector<json> points;
    strain_curve(points, "chain", "implicit_springs", 1, -0.5);
    strain_curve(points, "chain", "fast_projection", 0.1, -0.1);
    error_curve(points, "implicit_springs", 1, springs_error, gap);
    error_curve(points, "fast_projection", 1, -0.5, gap);
    return verdict("C1", points);
  };
  EXPECT_EQ(with(-0.1).verdict, "reproduced");
  EXPECT_TRUE(says(with(-0.1), "over the error at any limit: not reproduced, slope"));
  EXPECT_TRUE(says(with(-0.5), "over the error at any limit: undecided"));
  // A reference that is sure to 10 % tells nothing of smaller errors.
  EXPECT_TRUE(says(with(-1, 0.033), "over the error at any limit: not yet measured"));
}

// Runs that are fast because their motion is wrong count at any motion alone.
TEST(Claims, C1IsDecidedByRunsWhoseMotionIsRight) {
  std::vector<json> points;
  strain_curve(points, "chain", "implicit_springs", 1, -0.1);
  strain_curve(points, "chain", "fast_projection", 0.1, -0.5);
  for (json& p : points) p["error"]["trajectory"] = 0.4;
  for (json& p : points) p["best_at_errors"] = json::array();
  EXPECT_EQ(verdict("C1", points).verdict, "not yet measured");
  strain_curve(points, "chain", "implicit_springs", 10, -0.5, 0.001);
  strain_curve(points, "chain", "fast_projection", 1, -0.1, 0.001);
  for (std::size_t i = points.size() / 2; i < points.size(); ++i) points[i]["best"] = false;
  EXPECT_EQ(verdict("C1", points).verdict, "reproduced");
  EXPECT_TRUE(says(verdict("C1", points), "at any motion: not reproduced"));
}

TEST(Claims, C2NeedsASmallerExponentOverVertices) {
  const auto with = [](double springs, double fast, double noise = 0) {
    std::vector<json> points;
    for (const int n : {20, 40, 80, 160}) {
      for (const auto& [solver, exponent] :
           {std::pair("implicit_springs", springs), {"fast_projection", fast}})
        points.push_back(
            point("chain", "resolution", solver, 0.01, n, 0.01, std::pow(n / 20.0, exponent)));
    }
    return verdict("C2", points, noise);
  };
  EXPECT_EQ(with(2, 1).verdict, "reproduced");
  EXPECT_TRUE(says(with(2, 1), "ratio 1.000 (0.997-1.003) at 20 vertices, ratio 8.00 ("));
  EXPECT_EQ(with(1, 2).verdict, "not reproduced");
  EXPECT_EQ(with(1.2, 1, 0.5).verdict, "undecided");
}

TEST(Claims, C3NeedsItsIntervalOnOneSideOfEachBound) {
  const auto with = [](double ratio, double noise = 0, double right = 0) {
    std::vector<json> points{
        point("chain", "strain", "implicit_springs", 0.01, 80, 0.01, ratio * 1e-3),
        point("chain", "strain", "fast_projection", 0.01, 80, 0.01, 1e-3)};
    if (right > 0) {  // these are fast and wrong; those below are ten times as slow and right
      for (json& p : points) p["best_at_errors"] = json::array();
      for (json& p : points) p["error"]["trajectory"] = 0.4;
      points.push_back(point("chain", "strain", "implicit_springs", 0.01, 80, 0.001, right * 1e-2));
      points.push_back(point("chain", "strain", "fast_projection", 0.01, 80, 0.001, 1e-2));
      for (std::size_t i : {2, 3}) points[i]["best"] = false;
    }
    return verdict("C3", points, noise);
  };
  const struct {
    double ratio, noise, right;
    const char* verdict;
  } cases[] = {
      {25, 0, 0, "reproduced"},       {5, 0, 0, "changed"},       {100, 0, 0, "changed"},
      {0.9, 0, 0, "not reproduced"},  {0.9, 0.2, 0, "undecided"}, {14, 0.2, 0, "undecided"},
      {45, 0.2, 0, "undecided"},      {25, 0.2, 0, "reproduced"}, {25, 0, 25, "reproduced"},
      {25, 0, 0.5, "not reproduced"}, {25, 0.2, 1.1, "undecided"}};
  for (const auto& c : cases)
    EXPECT_EQ(with(c.ratio, c.noise, c.right).verdict, c.verdict) << c.ratio;
  EXPECT_TRUE(says(with(25), "100 steps of 2 iterations"));
  EXPECT_TRUE(says(with(25, 0.2), "ratio 25 (20-31)"));
  EXPECT_EQ(verdict("C3", {point("chain", "strain", "implicit_springs", 0.01, 20, 0.01, 25),
                           point("chain", "strain", "fast_projection", 0.01, 20, 0.01, 1)})
                .verdict,
            "not yet measured");  // the paper's chain has 80
  EXPECT_TRUE(says(with(25, 0, 0.5), "at any motion: reproduced"));
}

// The tension of a calibration over the weight a strand: of a chain all, of 21 x 21 vertices 1/42.
TEST(Claims, C4PredictsStrainFromOneSceneAndSize) {
  const auto calibration = [](double limit, double factor, double step = 0.01, bool chain = false) {
    json p = point(chain ? "chain" : "drape", "strain", "implicit_springs", limit, 441, step, 1);
    p["options"]["stiffness"] = factor * 9.81 / limit / (chain ? 1 : 42);
    return p;
  };
  // The strands' weight is the same law: a chain tells of a drape.
  const auto with = [&](double factor) {
    return verdict("C4", {calibration(0.1, 1, 0.01, true), calibration(0.03, 1, 0.01, true),
                          calibration(0.01, factor)});
  };
  EXPECT_TRUE(says(with(3),
                   "calibrated on chain of 441 vertices: the strain over its limit is chain of 441 "
                   "1, drape of 441 3; off by a factor of 3"));
  EXPECT_EQ(with(5).verdict, "reproduced");
  EXPECT_EQ(with(1).verdict, "not reproduced");
  EXPECT_EQ(with(1.1).verdict, "not reproduced");
  EXPECT_EQ(with(2.1).verdict, "undecided");  // the calibration's tolerance
  EXPECT_EQ(with(1.9).verdict, "undecided");
  // Another step's stiffness says nothing, nor do a time-out and a limit that was not met.
  const json one = calibration(0.1, 1), two = calibration(0.03, 1), three = calibration(0.01, 1);
  EXPECT_EQ(verdict("C4", {one, two, three, calibration(0.003, 9, 0.02)}).verdict,
            "not reproduced");
  json late = calibration(0.01, 9), loose = calibration(0.01, 9);
  late["status"] = "timeout";
  loose["max_strain"] = 0.005;
  EXPECT_EQ(verdict("C4", {one, two, late, loose}).verdict, "not yet measured");
}

TEST(Claims, C5AsksForFlatSlopesAndTheFirstPlaceForFastProjection) {
  const auto with = [](double shake_time, double limiting = -0.8, double noise = 0) {
    std::vector<json> points;
    strain_curve(points, "drape", "jacobi", 1, limiting);
    strain_curve(points, "drape", "gauss_seidel", 0.8, limiting);
    strain_curve(points, "drape", "shake", shake_time, -0.1);
    strain_curve(points, "drape", "icd", 3, -0.1);
    strain_curve(points, "drape", "fast_projection", 1.5, -0.1);
    return verdict("C5", points, noise);
  };
  EXPECT_EQ(with(2).verdict, "reproduced");
  EXPECT_TRUE(says(with(2), "flatter in 6 of 6 pairs"));
  EXPECT_TRUE(says(with(2), "fastest in 10 of 10 comparisons"));
  EXPECT_TRUE(says(with(2), "ahead of all strain limiting from 3 % down"));
  EXPECT_EQ(with(1).verdict, "changed");
  EXPECT_EQ(with(1, 0.2).verdict, "not reproduced");
  EXPECT_EQ(with(2, 0.2).verdict, "changed");
  EXPECT_EQ(with(1.6, -0.8, 0.1).verdict, "undecided");
  EXPECT_EQ(with(2, -0.2, 0.6).verdict, "undecided");
}

TEST(Claims, C6LooksAtEverySize) {
  const auto with = [](double small, double large, double noise = 0) {
    std::vector<json> points;
    for (const auto& [n, seconds] : {std::pair(100, small), std::pair(400, large)}) {
      points.push_back(point("drape", "resolution", "fast_projection", 0.01, n, 0.01, seconds));
      points.push_back(point("drape", "resolution", "gauss_seidel", 0.01, n, 0.01, 1.0));
    }
    return verdict("C6", points, noise);
  };
  EXPECT_EQ(with(0.5, 0.5).verdict, "reproduced");
  EXPECT_EQ(with(1.5, 0.5).verdict, "changed");
  EXPECT_EQ(with(0.5, 1.5).verdict, "not reproduced");
  EXPECT_EQ(with(0.5, 0.95, 0.1).verdict, "undecided");
  EXPECT_EQ(with(0.95, 0.5, 0.1).verdict, "undecided");
  EXPECT_EQ(with(0.95, 2, 0.1).verdict, "not reproduced");
  EXPECT_TRUE(says(with(0.5, 0.95, 0.1), "400: undecided, Gauss-Seidel takes 1.05 (0.95-1.16)"));
}

// Settings are tuned for a scene as a whole: where that harms a rival, its defaults count.
TEST(Claims, RivalsHaveTheFasterOfTheirTunedAndUntunedSettings) {
  const auto with = [](double untuned) {
    std::vector<json> points;
    for (const int n : {100, 400}) {
      points.push_back(point("drape", "resolution", "fast_projection", 0.01, n, 0.01, 1));
      points.push_back(point("drape", "resolution", "gauss_seidel", 0.01, n, 0.01, 2));
      points.push_back(point("drape", "resolution", "gauss_seidel", 0.01, n, 0.01, untuned));
      points.back()["contestant"] = "gauss_seidel_untuned";
    }
    json result = document(points, 0.1);
    result["legend"]["solvers"] = {{{"name", "gauss_seidel_untuned"},
                                    {"solver", "gauss_seidel"},
                                    {"family", "gauss_seidel"},
                                    {"unranked", true}}};
    return verdict_in("C6", result);
  };
  EXPECT_EQ(with(3).verdict, "reproduced");
  EXPECT_EQ(with(0.5).verdict, "not reproduced");
  EXPECT_TRUE(says(with(0.5), "Gauss-Seidel takes 0.5"));
}

}  // namespace
}  // namespace harness
