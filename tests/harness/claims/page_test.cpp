// The page of results says no more than its files do: bold and intervals only beyond the noise,
// strains and failures beside every ranking.
#include "harness/claims/page.h"

#include <gtest/gtest.h>

#include <sstream>

#include "harness/claims/results_page.h"
#include "invented_points.h"

namespace harness {
namespace {

json sweep(double noise = 0, double untuned_icd = 4.0) {
  std::vector<json> points;
  for (const auto& [contestant, solver, seconds] :
       {std::tuple("fast_projection", "fast_projection", 1.0),
        std::tuple("fast_projection_again", "fast_projection", 0.5), std::tuple("icd", "icd", 2.0),
        std::tuple("icd_untuned", "icd", untuned_icd)}) {
    json p = point("drape", "strain", solver, 0.01, 441, 0.01, seconds);
    p["contestant"] = contestant;
    p["p99_strain"] = 0.009;
    p["rms_strain"] = 0.004;
    p["max_strain_after_collision"] = solver == std::string("icd") ? 0.08 : 0.18;
    p["delivered_strain_p99"] = 0.02;
    p["error"]["energy_gain"] = -0.25;
    p["phases"] = {{"unconstrained", 0.1}, {"filter", 0.6}, {"collision", 0.3}};
    p["filter_seconds_per_simulated_second"] = timing(0.6 * seconds);
    points.push_back(p);
  }
  points[2]["at_ladder_end"] = "coarsest";
  points.push_back(point("drape", "strain", "icd", 0.01, 441, 0.02, 1));
  points.back()["status"] = "diverged";
  points.back()["best"] = false;
  json result = document(points, noise);
  result["legend"]["solvers"] = {
      {{"name", "fast_projection"}, {"family", "fast_projection"}},
      {{"name", "icd"}, {"family", "icd"}},
      {{"name", "icd_untuned"}, {"solver", "icd"}, {"family", "icd"}, {"hollow", true}}};
  for (const char* key : {"date", "cpu_model"}) result["context"][key] = "x";
  result["context"]["build"]["git"] = "abc";
  return result;
}

std::string page(const json& result) {
  std::ostringstream out;
  print_results_page(out, {{"file.json", result}}, {});
  return out.str();
}

bool has(const std::string& text, const std::string& words) {
  const bool found = text.find(words) != std::string::npos;
  EXPECT_TRUE(found) << words << "\nin\n" << text;
  return found;
}

TEST(ResultsPage, RatiosHaveIntervalsAndOnlyTheClearlyFastestIsBold) {
  const std::string quiet = page(sweep(0.01)), noisy = page(sweep(0.8));
  has(quiet, "| `fast_projection` | **1** |");
  has(quiet, "| `icd` | 2.00 (1.98-2.02) |");
  has(noisy, "| `fast_projection` | 1 |");
  has(noisy, "| `icd` | 2.00 (0.90-4.45) |");
}

TEST(ResultsPage, WithoutIntervalsNothingIsBold) {
  json result = sweep();
  for (json& p : result["points"])
    p["seconds_per_simulated_second"] = timing(p["seconds_per_simulated_second"]["min"], 3);
  result["context"].erase("noise");
  const std::string text = page(result);
  EXPECT_EQ(text.find("**"), std::string::npos);
  has(text, "| `icd` | 2 (?) |");
}

TEST(ResultsPage, TheDoubleIsNoContestant) {
  const std::string text = page(sweep(0.01));
  EXPECT_EQ(text.find("fast_projection_again"), std::string::npos);
  has(text, "| `fast_projection` | **1** |");  // not the double's 0.5
  has(text, "| `file.json` | x | x | abc | `fast_projection` | 20 | - | 1.01 % |");
}

TEST(ResultsPage, ASolverStandsThereWithTheFasterOfItsTunedAndUntunedSettings) {
  const std::string gained = page(sweep(0.01)), lost = page(sweep(0.01, 0.1));
  has(gained, "| `icd` | 2 |");
  has(gained, "| untuned | tuned | 1 %, ratio |\n|---|---|---|\n| `icd_untuned` | `icd` | 2.00 (");
  has(lost, "| `fast_projection` | 1 |\n| `icd` | **0.1** `u` |");
  has(lost, "| untuned | tuned | 1 %, ratio |\n|---|---|---|\n| `icd_untuned` | `icd` | 0.050 (");
}

TEST(ResultsPage, StepsAtTheLaddersEndSaySo) {
  const std::string text = page(sweep(0.01));
  has(text, "| `icd` | 1/100 (coarsest), 1 % |");
  has(text, "| `fast_projection` | 1/100, 1 % |");
}

TEST(ResultsPage, StrainsFilterEnergyAndFailuresStandBesideTheRanking) {
  const std::string text = page(sweep(0.01));
  has(text, "before the collision filter");
  has(text, "| `icd` | 1, 0.9, 0.4 |");
  has(text, "| `icd` | 8, 2, - |");
  has(text, "| `icd` | 1.2, 60 % |");
  has(text, "| `icd` | -0.25 |");
  has(text, "| solver | `ok`, runs | `diverged`, runs |");
  has(text, "| `icd` | 1 | 1 |");
}

TEST(ResultsPage, TheSecondRankingIsByDeliveredStrain) {
  const std::string text = page(sweep(0.01));
  has(text, "The least such strain of any run: 8 %.");
  const auto table = text.substr(text.find("## Time over delivered strain"));
  has(table, "| 20 %: time in s, step in s | 10 %: time in s, step in s |");
  has(table, "**1**, 1/100 | - |\n| `icd` |");
}

TEST(ResultsPage, OlderFilesHaveDashesWhereTheySayNothing) {
  json result = sweep(0.01);
  for (json& p : result["points"]) {
    for (const char* key : {"delivered_strain_p99", "contestant", "phases",
                            "filter_seconds_per_simulated_second", "p99_strain"})
      p.erase(key);
    p["error"].erase("energy_gain");
  }
  result["points"].erase(result["points"].begin() + 1);
  result["context"].erase("noise");
  const std::string text = page(result);
  has(text, "| `icd` | 1, -, 0.4 |");
  has(text, "| `icd` | 8, -, - |");
  EXPECT_EQ(text.find("gain of energy"), std::string::npos);
}

TEST(ResultsPage, ErrorsCountWhereTheReferenceIsSure) {
  json p = point("chain", "step", "icd", 0.01, 80, 0.01, 1);
  p["error"] = {{"trajectory", 0.5}, {"gap", 0.2}};
  EXPECT_FALSE(claims::Point(p).within_error(0.1));
  // At 0.1 s the error is 0.01 and sure, at 0.2 s the two references have parted.
  p["error"]["error_series"] = {{0.1, 0.01, 0.02, 1e-6, 1e-6}, {0.2, 0.7, 0.9, 0.5, 0.5}};
  EXPECT_TRUE(claims::Point(p).within_error(0.1));
  EXPECT_TRUE(claims::Point(p).within_error(0.01));
  EXPECT_FALSE(claims::Point(p).within_error(0.009));
  p["error"]["error_series"] = {{0.1, 0.01, 0.02, 0.05, 0.05}};
  EXPECT_FALSE(claims::Point(p).within_error(0.1));  // 3 gaps are more
}

TEST(ResultsPage, ErrorsSayUntilWhenTheyCount) {
  json result = sweep(0.01);
  std::vector<json> points;
  for (const char* solver : {"fast_projection", "icd"}) {
    points.push_back(point("chain", "step", solver, 0.01, 80, 0.01, 1));
    points.back()["error"] = {{"trajectory", 0.05},
                              {"gap", 0.002},
                              {"error_series", {{0.1, 0.02, 0, 1e-6, 0}, {0.7, 0.07, 0, 0.03, 0}}}};
  }
  result["points"] = points;
  const std::string text = page(result);
  has(text, "| solver | 10 %, up to 0.7 s: time in ms, step in s | 3 %, up to 0.1 s: time in ms");
  has(text, "| `icd` | 1000, 1/100 | 1000, 1/100 |");
}

TEST(ResultsPage, ThePlaneHasShapeErrorsWhereTheyAreKnown) {
  json result = sweep(0.01);
  json p = point("drape", "strain", "icd", 0.01, 441, 0.01, 1);
  p["error"] = {{"trajectory", 0.05}};
  result["points"] = {p};
  EXPECT_EQ(page(result).find("hape"), std::string::npos);
  p["error"]["shape"] = 0.031;
  result["points"] = {p};
  has(page(result), "shape by 3.1 %");
  has(page(result), "Shape errors are deviations beyond the ensemble's spread.");
}

}  // namespace
}  // namespace harness
