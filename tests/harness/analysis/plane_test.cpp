// The plane strain x error of a result file whose times are made up.
#include "harness/analysis/plane.h"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/analysis/plane_json.h"
#include "harness/points/result_file.h"
#include "harness/points/schema_check.h"
#include "harness/run/plane_table.h"

namespace harness::analysis {
namespace {

using nlohmann::json;

// A run of a chain of 80 that takes so many seconds and is off by `error`. The reference is sure to
// 0.1 % at 0.5 s, and to 6 % at 1 s, where every run is off by 40 %.
json run(const std::string& contestant, double limit, double step, double seconds, double error,
         bool best = false, const std::vector<double>& best_at_errors = {}) {
  std::ostringstream id;
  id << "chain/" << contestant << "/n:80/strain:" << limit << "/h:" << step;
  json samples = json::array();
  for (int i = -4; i <= 4; ++i) samples.push_back(seconds * (1 + 0.001 * i));
  return {{"id", id.str()},
          {"scene", "chain"},
          {"sweep", "strain"},
          {"contestant", contestant},
          {"solver", contestant.substr(0, contestant.find("_untuned"))},
          {"status", "ok"},
          {"best", best},
          {"best_at_errors", best_at_errors},
          {"strain_limit", limit},
          {"vertices", 80},
          {"resolution", 80},
          {"step", step},
          {"scene_parameters", {{"n", 80.0}, {"duration", 1.0}}},
          {"error",
           {{"reference", "chain-n80.json"},
            {"trajectory", error},
            {"error_series", {{0.5, error, error, 0.0003, 0.0003}, {1.0, 0.4, 0.4, 0.02, 0.02}}}}},
          {"seconds_per_simulated_second", {{"median", seconds}, {"samples", samples}}}};
}

json document(const std::vector<json>& points) {
  return {{"schema", "inextensible-bench/1"},
          {"context", {{"suite", {{"finest_error", 0.01}}}}},
          {"legend",
           {{"solvers",
             {{{"name", "strips"}, {"family", "strips"}},
              {{"name", "icd"}, {"family", "icd"}},
              {{"name", "icd_untuned"}, {"solver", "icd"}, {"family", "icd"}, {"hollow", true}},
              {{"name", "shake"}, {"family", "shake"}},
              {{"name", "null"}, {"family", "none"}, {"contestant", false}}}}}},
          {"points", points}};
}

std::string winner(const Cell& cell) {
  return cell.first() ? cell.first()->point.id() : "none: " + cell.empty_because;
}

TEST(Plane, HasTheFastestRunOfEachCell) {
  const json result = document({
      run("strips", 0.1, 0.04, 1, 0.08), run("strips", 0.1, 0.02, 2, 0.03),
      run("strips", 0.1, 0.01, 6, 0.008), run("icd", 0.1, 0.04, 3, 0.015),
      run("icd_untuned", 0.1, 0.02, 2.5, 0.018), run("shake", 0.1, 0.01, 9, 0.004),
      run("null", 0.1, 0.04, 0.1, 0),     // does not compete
      run("icd", 0.1, 0.2, 0.01, 0.004),  // a step longer than a frame
      run("shake", 0.01, 0.01, 9, 0.03),  // nobody else keeps 1 %
  });
  const auto planes = planes_of(result);
  ASSERT_EQ(planes.size(), 1u);
  const Plane& plane = planes[0];
  EXPECT_EQ(plane.limits, (std::vector<double>{0.1, 0.01}));
  EXPECT_EQ(plane.levels, (std::vector<double>{any_motion, 0.1, 0.05, 0.02, 0.01}));
  const auto at = [&](double level) { return winner(plane.cell(0.1, level)); };
  EXPECT_EQ(at(any_motion), "chain/strips/n:80/strain:0.1/h:0.04");
  // 10 % counts the sample at 1 s too, where all are off by 40 %: root mean square 0.28.
  EXPECT_EQ(at(0.1), "none: no run that was tried is right to 10 %");
  EXPECT_EQ(at(0.05), "chain/strips/n:80/strain:0.1/h:0.02");
  EXPECT_EQ(at(0.02), "chain/icd_untuned/n:80/strain:0.1/h:0.02");
  EXPECT_EQ(at(0.01), "chain/strips/n:80/strain:0.1/h:0.01");
  const Cell& headline = plane.cell(0.1, 0.02);
  EXPECT_EQ(headline.first()->row, "icd");
  EXPECT_EQ(headline.counting(1)->row, "strips") << "the slower icd does not count";
  EXPECT_EQ(headline.next_family()->row, "strips");
  EXPECT_EQ(headline.paper_best(), headline.first());
  EXPECT_FALSE(headline.lead_over(headline.paper_best()));
  EXPECT_TRUE(headline.clear());
  EXPECT_DOUBLE_EQ(headline.known_until, 0.5);
  EXPECT_DOUBLE_EQ(headline.first()->error, 0.018);
  const Cell& finest = plane.cell(0.1, 0.01);
  EXPECT_EQ(finest.paper_best()->row, "shake");
  EXPECT_NEAR(finest.lead_over(finest.paper_best())->value, 1.5, 1e-12);
  EXPECT_EQ(winner(plane.cell(0.01, 0.02)), "none: no run that was tried is right to 2 %");
}

TEST(Plane, TakesTheRunThatTheSweepMarked) {
  const json result =
      document({run("icd", 0.1, 0.04, 1, 0.015), run("icd", 0.1, 0.02, 1.1, 0.01, true, {0.02}),
                run("icd", 0.1, 0.01, 1.2, 0.008, false, {0.01})});
  const auto planes = planes_of(result);
  const Plane& plane = planes.at(0);
  EXPECT_EQ(winner(plane.cell(0.1, any_motion)), "chain/icd/n:80/strain:0.1/h:0.02");
  EXPECT_EQ(winner(plane.cell(0.1, 0.02)), "chain/icd/n:80/strain:0.1/h:0.02");
  EXPECT_EQ(winner(plane.cell(0.1, 0.01)), "chain/icd/n:80/strain:0.1/h:0.01");
  EXPECT_EQ(winner(plane.cell(0.1, 0.05)), "chain/icd/n:80/strain:0.1/h:0.04") << "no mark";
}

TEST(Plane, SaysWhyACellIsEmpty) {
  json failed = run("icd", 0.1, 0.01, 1, 0.01);
  failed["status"] = "strain_missed";
  json unsure = run("icd", 0.01, 0.01, 1, 0.01);
  unsure["error"]["error_series"] = {{0.5, 0.01, 0.01, 0.009, 0.009}};
  json alone = run("icd", 0.001, 0.01, 1, 0.01);
  alone["error"] = {{"reference", nullptr}, {"trajectory", nullptr}, {"gap", nullptr}};
  const json result = document({failed, unsure, alone});
  const auto planes = planes_of(result);
  EXPECT_EQ(winner(planes.at(0).cell(0.1, any_motion)), "none: no run keeps the strain limit");
  EXPECT_EQ(winner(planes.at(0).cell(0.01, 0.02)), "none: the reference is not sure to 2 %");
  EXPECT_EQ(winner(planes.at(0).cell(0.01, 0.05)), "chain/icd/n:80/strain:0.01/h:0.01");
  EXPECT_EQ(winner(planes.at(0).cell(0.001, 0.05)), "none: there is no reference");
}

// As large as files come: all committed sweeps, which were made before there were levels of error.
TEST(Plane, ReadsOlderFiles) {
  for (const char* name : {"default-strain", "default-resolution", "default-step"}) {
    const json result = read_result(std::string(SOURCE_DIR) + "/results/" + name + ".json");
    const json analysis = analysis_of(result);
    EXPECT_NO_THROW(check_schema(analysis, "analysis", name));
    EXPECT_GE(analysis.at("planes").size(), 2u);
    for (const json& plane : analysis.at("planes"))
      EXPECT_TRUE(plane.at("cells").at(0).at("first").is_string()) << name;
  }
}

// What is printed, and what programs read, is what was analysed.
TEST(Plane, IsPrintedAndWrittenAsItIs) {
  const json result =
      document({run("strips", 0.1, 0.04, 1e-3, 0.008), run("icd", 0.1, 0.04, 3e-3, 0.03),
                run("shake", 0.1, 0.02, 2e-3, 0.01)});
  std::ostringstream out;
  print_planes(out, result);
  EXPECT_NE(out.str().find("chain of 80 vertices"), std::string::npos);
  EXPECT_NE(out.str().find("10 %     any          strips"), std::string::npos) << out.str();
  EXPECT_NE(out.str().find("2.00 (1.99-2.01) by shake"), std::string::npos) << out.str();
  std::istringstream lines(out.str());
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
  const json analysis = analysis_of(result);
  EXPECT_NO_THROW(check_schema(analysis, "analysis", "analysis"));
  const json& cell = analysis.at("planes").at(0).at("cells").at(3);
  EXPECT_EQ(cell.at("error_level"), 0.02);
  EXPECT_EQ(cell.at("first"), "strips");
  EXPECT_EQ(cell.at("paper_best"), "shake");
  EXPECT_EQ(cell.at("clear"), true);
  EXPECT_NEAR(cell.at("lead_over_paper_best").at("value").get<double>(), 2, 1e-12);
  EXPECT_EQ(cell.at("entries").size(), 2u);
}

TEST(Plane, TellsTheShapeErrorsOfTheFastest) {
  std::vector<json> runs;
  for (const double limit : {0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0002, 0.0001}) {
    runs.push_back(run("strips", limit, 0.04, 1e-3, 0.008));
    runs.back()["error"]["shape"] = limit;
  }
  const json result = document(runs);
  std::ostringstream out;
  print_planes(out, result);
  EXPECT_NE(out.str().find("shape errors of the fastest, whatever their motion: 10 %: 10 %, 5 %"),
            std::string::npos)
      << out.str();
  std::istringstream lines(out.str());
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
  const json cell = analysis_of(result).at("planes").at(0).at("cells").at(0);
  EXPECT_EQ(cell.at("entries").at(0).at("shape_error"), 0.1);
}

}  // namespace
}  // namespace harness::analysis
