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
      told({run("yarn_projection", 0.01, 0.01, 0.05, 0.014), run("icd", 0.01, 0.005, 0.2, 0.01),
            run("shake", 0.01, 0.01, 0.1, 0.012)});
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_EQ(sentences[0],
            "At 1 % strain, motion error at most 2 %, yarn_projection is the fastest: 49.8 ms a "
            "simulated second with "
            "steps of 1/100 s and an error of 1.4 %; shake, the best of the paper's six, takes "
            "2.00 (1.99-2.01) times as long.");
}

TEST(Findings, NameNoWinnerWithinTheNoise) {
  const auto sentences =
      told({run("yarn_projection", 0.01, 0.01, 0.0500, 0.01), run("icd", 0.01, 0.01, 0.0501, 0.01),
            run("shake", 0.01, 0.01, 0.1, 0.01)});
  EXPECT_NE(sentences.at(0).find("yarn_projection and icd are the fastest, too close to rank: "),
            std::string::npos)
      << sentences[0];
  EXPECT_NE(sentences[0].find("; shake, the next, takes 2.0"), std::string::npos) << sentences[0];
}

// No run has an error of at most 2 %: the nearest looser level is answered.
TEST(Findings, AnswerTheNearestQuestionThatHasAnAnswer) {
  EXPECT_EQ(told({run("yarn_projection", 0.01, 0.01, 0.05, 0.04), run("icd", 0.01, 0.01, 0.1, 0.3)})
                .at(0)
                .substr(0, 71),
            "At 1 % strain, motion error at most 5 %, only yarn_projection has a run");
  EXPECT_EQ(told({run("yarn_projection", 0.01, 0.01, 0.05, 0.3)}).at(0).substr(0, 36),
            "At 1 % strain, whatever the motion, ");
  json failed = run("yarn_projection", 0.01, 0.01, 0.05, 0.3);
  failed["status"] = "diverged";
  EXPECT_EQ(
      told({failed}).at(0),
      "At 1 % strain, whatever the motion, there is no answer: no run keeps the strain limit.");
}

}  // namespace
}  // namespace harness::analysis
