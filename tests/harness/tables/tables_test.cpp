// Tables of invented results. The page says no more than its files do: bold and intervals only
// beyond the noise. A terminal's are never wider than it may be, and have everybody if asked for.
#include "harness/tables/tables.h"

#include <gtest/gtest.h>

#include <iterator>
#include <sstream>

#include "support/invented_points.h"

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
    p["max_strain_after_collision"] = solver == std::string("icd") ? 0.08 : 0.18;
    points.push_back(p);
  }
  points.push_back(point("drape", "strain", "icd", 0.01, 441, 0.02, 1));
  points.back()["status"] = "diverged";
  points.back()["best"] = false;
  json result = document(points, noise);
  result["legend"]["solvers"] = {
      {{"name", "fast_projection"}, {"family", "fast_projection"}},
      {{"name", "icd"}, {"family", "icd"}},
      {{"name", "icd_untuned"}, {"solver", "icd"}, {"family", "icd"}, {"unranked", true}}};
  for (const char* key : {"date", "cpu_model"}) result["context"][key] = "x";
  result["context"]["build"]["git"] = "abc";
  return result;
}

std::string page(const json& result) {
  std::ostringstream out;
  print_results_page(out, {{"file.json", result}}, {});
  return out.str();
}

void has(const std::string& text, const std::string& words) {
  EXPECT_NE(text.find(words), std::string::npos) << words << "\nin\n" << text;
}

TEST(ResultsPage, OnlyTheClearlyFastestIsBoldAndRatiosHaveIntervals) {
  const std::string quiet = page(sweep(0.01)), noisy = page(sweep(0.8));
  has(quiet, "| 1 % | **`fast_projection`** 1000 ms, 1/100");
  has(quiet,
      "fast_projection is the fastest: 1 s a simulated second with steps of 1/100 s and an "
      "error of 1 %; icd, the next, takes 2.00 (1.98-2.02) times as long.");
  has(noisy, "| 1 % | `fast_projection` 1000 ms, 1/100");
  has(noisy, "fast_projection and icd are the fastest, too close to rank");
  const std::string untuned = page(sweep(0.01, 0.1));  // the faster of a solver's settings
  has(untuned, "| 1 % | **`icd` `u`** 100 ms");
  has(untuned, "icd with untuned settings is the fastest");
}

// A mean over a third of the run says nothing of its end.
TEST(ResultsPage, SaysUpToWhenErrorsCountUnlessItIsTheWholeRun) {
  const auto with = [](double last) {
    json result = sweep(0.01);
    for (json& p : result["points"])
      p["error"]["error_series"] = {{0.1, 0.01, 0.02, 1e-6, 1e-6}, {last, 0.01, 0.02, 1e-6, 1e-6}};
    return page(result);
  };
  has(with(0.36), "Errors of 2 % are known up to 0.36 s of 1 s");
  EXPECT_EQ(with(1.0).find("are known up to"), std::string::npos);
}

// ---- On a terminal ----

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

TEST(Terminal, IsNoWiderThanItMayBeAndLosesNoWord) {
  const json result =
      invented::document({invented::run("fast_projection_adaptive@bdf2", 0.1, 0.04, 1e-3, 0.008),
                          invented::run("icd", 0.1, 0.04, 3e-3, 0.03),
                          invented::run("fast_projection", 0.1, 0.02, 2e-3, 0.01)});
  std::ostringstream whole;
  print_sweep(whole, result, "", true, 1000);
  for (const char* words : {"chain, 80 vertices, over strain", "2.00 (1.99-2.01) fast_projection"})
    EXPECT_NE(whole.str().find(words), std::string::npos) << whole.str();
  for (const std::size_t columns : {60, 80, 100}) {
    std::ostringstream out;
    print_sweep(out, result, "", true, columns);
    EXPECT_EQ(words_of(out.str()), words_of(whole.str()));
    std::istringstream lines(out.str());
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), columns) << line;
  }
}

TEST(Terminal, NamesPluginsAndTheCostOfCopying) {
  json engine = invented::run("engine", 0.1, 0.04, 1e-3, 0.008),
       other = invented::run("filter", 0.1, 0.04, 2e-3, 0.01);
  engine["phases"].update(
      {{"unconstrained", 0.1}, {"filter", 0.7}, {"collision", 0}, {"copy", 0.2}});
  json failed = engine;
  failed["status"] = "diverged";
  failed["phases"]["copy"] = 9;
  json result = invented::document({engine, other, failed});
  std::ostringstream without, with;
  print_sweep(without, result, "");
  EXPECT_EQ(without.str().find("plug-in"), std::string::npos);
  result["context"]["plugins"] = {{{"version", "Engine 1.2"}, {"solvers", {"engine"}}},
                                  {{"version", "3"}, {"solvers", {"filter"}}}};
  print_sweep(with, result, "");
  EXPECT_NE(
      with.str().find("plug-in engine: Engine 1.2; copying its state takes 20 % of its time\n"),
      std::string::npos)
      << with.str();
  EXPECT_NE(with.str().find("plug-in filter: 3\n"), std::string::npos) << with.str();
}

}  // namespace
}  // namespace harness
