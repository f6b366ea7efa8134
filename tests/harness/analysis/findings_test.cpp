// Answers in words, of times that are made up.
#include "harness/analysis/findings.h"

#include <gtest/gtest.h>

#include "support/invented_runs.h"

namespace harness::analysis {
namespace {

using invented::document;
using invented::run;
using nlohmann::json;

std::vector<std::string> told(const std::vector<json>& runs) {
  const json result = document(runs);
  const auto findings = findings_of(planes_of(result));
  EXPECT_EQ(findings.size(), 1u);
  return findings.at(0).sentences;
}

TEST(Findings, NameTheFirstItsPriceAndTheBestOfThePaper) {
  const auto sentences =
      told({run("strips", 0.01, 0.01, 0.05, 0.014), run("icd", 0.01, 0.005, 0.2, 0.01),
            run("shake", 0.01, 0.01, 0.1, 0.012)});
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_EQ(sentences[0],
            "At 1 % strain, right to 2 %, strips is the fastest: 49.8 ms a simulated second with "
            "steps of 1/100 s and an error of 1.4 %; shake, the best of the paper's six, takes "
            "2.00 (1.99-2.01) times as long.");
}

TEST(Findings, NameNoWinnerWithinTheNoise) {
  const auto sentences =
      told({run("strips", 0.01, 0.01, 0.0500, 0.01), run("icd", 0.01, 0.01, 0.0501, 0.01),
            run("shake", 0.01, 0.01, 0.1, 0.01)});
  EXPECT_NE(sentences.at(0).find("strips and icd are the fastest, too close to tell apart: "),
            std::string::npos)
      << sentences[0];
  EXPECT_NE(sentences[0].find("; shake, the next, takes 2.0"), std::string::npos) << sentences[0];
}

// Three samples a run and no A/A pair give no interval: nobody is called equal, nobody the winner.
TEST(Findings, SayWhereSamplesAreTooFew) {
  json strips = run("strips", 0.01, 0.01, 0.05, 0.01), icd = run("icd", 0.01, 0.01, 0.5, 0.01);
  for (json* one : {&strips, &icd}) {
    json& samples = (*one)["seconds_per_simulated_second"]["samples"];
    while (samples.size() > 3) samples.erase(samples.size() - 1);
  }
  const auto sentences = told({strips, icd});
  EXPECT_NE(sentences.at(0).find("strips has the least time, of too few samples to be sure: "),
            std::string::npos)
      << sentences[0];
  EXPECT_NE(sentences[0].find("icd, the best of the paper's six, takes "), std::string::npos)
      << sentences[0];
}

// No run is right to 2 %: the nearest looser level is answered.
TEST(Findings, AnswerTheNearestQuestionThatHasAnAnswer) {
  EXPECT_EQ(told({run("strips", 0.01, 0.01, 0.05, 0.04), run("icd", 0.01, 0.01, 0.1, 0.3)})
                .at(0)
                .substr(0, 48),
            "At 1 % strain, right to 5 %, strips alone has an");
  EXPECT_EQ(told({run("strips", 0.01, 0.01, 0.05, 0.3)}).at(0).substr(0, 36),
            "At 1 % strain, whatever the motion, ");
  json failed = run("strips", 0.01, 0.01, 0.05, 0.3);
  failed["status"] = "diverged";
  EXPECT_EQ(
      told({failed}).at(0),
      "At 1 % strain, whatever the motion, there is no answer: no run keeps the strain limit.");
}

TEST(Findings, TellWhatATighterLimitOrAnyMotionChanges) {
  const auto tighter =
      told({run("strips", 0.01, 0.01, 0.05, 0.01), run("icd", 0.01, 0.01, 0.1, 0.01),
            run("strips", 0.001, 0.01, 0.3, 0.01), run("icd", 0.001, 0.01, 0.2, 0.01)});
  ASSERT_EQ(tighter.size(), 2u);
  EXPECT_EQ(tighter[1].substr(0, 54), "At 0.1 % strain, right to 2 %, icd is the fastest: 199");
  const auto any = told({run("strips", 0.01, 0.01, 0.05, 0.01), run("icd", 0.01, 0.04, 0.01, 0.2)});
  ASSERT_EQ(any.size(), 2u);
  EXPECT_EQ(any[1].substr(0, 61), "At 1 % strain, whatever the motion, icd is the fastest: 9.96 ");
}

TEST(Findings, CallAMeshByItsFile) {
  json one = run("strips", 0.01, 0.01, 0.05, 0.01);
  one["scene"] = "mesh:clothes/shirt.obj,pins=y>1.2";
  const json result = document({one});
  EXPECT_EQ(findings_of(planes_of(result)).at(0).subject, "shirt.obj of 80 vertices");
}

}  // namespace
}  // namespace harness::analysis
