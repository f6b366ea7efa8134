// The strain-error grid and findings of invented times.
#include "harness/analysis/plane.h"
#include "support/invented_runs.h"

namespace harness::analysis {
namespace {

using invented::document, invented::run;

std::string winner(const Cell& cell) {
  return cell.first() ? cell.first()->point.id() : "none: " + cell.empty_because;
}

TEST(Plane, HasTheFastestRunOfEachCell) {
  const json result = document(
      {run("yarn_projection", 0.1, 0.04, 1, 0.08), run("yarn_projection", 0.1, 0.02, 2, 0.03),
       run("yarn_projection", 0.1, 0.01, 6, 0.008), run("icd", 0.1, 0.04, 3, 0.015),
       run("icd_untuned", 0.1, 0.02, 2.5, 0.018), run("shake", 0.1, 0.01, 9, 0.004),
       run("null", 0.1, 0.04, 0.1, 0),       // does not compete
       run("icd", 0.1, 0.2, 0.01, 0.004),    // a step longer than a frame
       run("shake", 0.01, 0.01, 9, 0.03)});  // nobody else keeps 1 %
  const auto planes = planes_of(result);
  ASSERT_EQ(planes.size(), 1u);
  const Plane& plane = planes[0];
  EXPECT_EQ(plane.limits, (std::vector<double>{0.1, 0.01}));
  EXPECT_EQ(plane.levels, (std::vector<double>{any_motion, 0.1, 0.05, 0.02, 0.01}));
  const auto at = [&](double level) { return winner(plane.cell(0.1, level)); };
  EXPECT_EQ(at(any_motion), "chain/yarn_projection/n:80/strain:0.1/h:0.04");
  // 10 % counts the sample at 1 s too, where all are off by 40 %: root mean square 0.28.
  EXPECT_EQ(at(0.1), "none: no run that was tried has a motion error of at most 10 %");
  EXPECT_EQ(at(0.05), "chain/yarn_projection/n:80/strain:0.1/h:0.02");
  EXPECT_EQ(at(0.02), "chain/icd_untuned/n:80/strain:0.1/h:0.02");
  EXPECT_EQ(at(0.01), "chain/yarn_projection/n:80/strain:0.1/h:0.01");
  const Cell& headline = plane.cell(0.1, 0.02);
  EXPECT_EQ(headline.first()->row, "icd");
  EXPECT_EQ(headline.counting(1)->row, "yarn_projection") << "the slower icd does not count";
  EXPECT_EQ(headline.rival(Rival::next_family)->row, "yarn_projection");
  EXPECT_EQ(headline.rival(Rival::paper_best), headline.first());
  EXPECT_FALSE(headline.lead_over(headline.rival(Rival::paper_best)));
  EXPECT_TRUE(headline.clear());
  EXPECT_DOUBLE_EQ(headline.known_until, 0.5);
  EXPECT_DOUBLE_EQ(headline.first()->error, 0.018);
  const Cell& finest = plane.cell(0.1, 0.01);
  EXPECT_EQ(finest.rival(Rival::paper_best)->row, "shake");
  EXPECT_NEAR(finest.lead_over(finest.rival(Rival::paper_best))->value, 1.5, 1e-12);
  EXPECT_EQ(winner(plane.cell(0.01, 0.02)),
            "none: no run that was tried has a motion error of at most 2 %");
}

// Ahead on the first day by what is little between days.
TEST(Plane, LeaderIsClearOnlyWhereItLeadsOnEveryOccasion) {
  const auto result = [](double third_day) {
    json all = document({run("icd", 0.1, 0.01, 1, 0.01, true, {0.02}),
                         run("shake", 0.1, 0.01, 1.2, 0.01, true, {0.02})});
    all["context"]["scatter"] = 0.01;
    all["points"][0]["occasions"] = {{1, 1.0, 1.0}, {2, third_day, third_day}};
    all["points"][1]["occasions"] = {{1, 1.2, 1.2}, {2, 1.2, 1.2}};
    return all;
  };
  for (const auto& [third_day, clear] : {std::pair(1.0, true), {1.17, false}, {1.3, false}}) {
    const json all = result(third_day);
    const auto planes = planes_of(all);
    const Cell& cell = planes.at(0).cell(0.1, 0.02);
    EXPECT_EQ(cell.clear(), clear) << third_day;
    const Ratio lead = *cell.lead_over(cell.counting(1));
    EXPECT_NEAR(lead.value, 1.2 / std::cbrt(third_day), 1e-12) << "mean of the days";
    EXPECT_TRUE(lead.low <= 1.2 / third_day && lead.high >= 1.2);
    const Coverage coverage = coverage_of(all);
    EXPECT_EQ(coverage.occasions, 3);
    EXPECT_EQ(coverage.ratios, 3) << "one pair, each day against the others";
    EXPECT_EQ(coverage.outside > 0, third_day > 1) << third_day;
  }
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

// The leader's time over its method's in the published stepper, and over others in its own.
TEST(Plane, SplitsTheLeadBetweenStepperAndMethod) {
  const json result = document(
      {run("yarn_projection@bdf2", 0.1, 0.01, 2, 0.01), run("yarn_projection", 0.1, 0.01, 6, 0.01),
       run("icd@bdf2", 0.1, 0.01, 3, 0.01), run("icd", 0.1, 0.01, 10, 0.01),
       run("gauss_seidel_colored", 0.1, 0.01, 5, 0.01), run("jacobi", 0.1, 0.01, 1, 0.2)});
  const auto planes = planes_of(result);
  const Cell& cell = planes.at(0).cell(0.1, 0.02);
  EXPECT_EQ(cell.first()->row, "yarn_projection@bdf2");
  EXPECT_EQ(cell.rival(Rival::first_as_published)->row, "yarn_projection");
  EXPECT_NEAR(cell.lead_over(cell.rival(Rival::first_as_published))->value, 3, 1e-12);
  EXPECT_EQ(cell.rival(Rival::rival_in_stepper)->row, "icd@bdf2");
  EXPECT_NEAR(cell.lead_over(cell.rival(Rival::rival_in_stepper))->value, 1.5, 1e-12);
  EXPECT_EQ(cell.rival(Rival::paper_best)->row, "icd") << "as published";
  EXPECT_EQ(cell.rival(Rival::paper_in_any_stepper)->row, "icd@bdf2");
  const Cell& any = planes.at(0).cell(0.1, any_motion);
  EXPECT_EQ(any.rival(Rival::first_as_published), any.first());
  EXPECT_EQ(any.rival(Rival::rival_in_stepper)->row, "gauss_seidel_colored");
}

TEST(Plane, TakesARunAtATighterLimitWhereThatIsFaster) {
  const json result =
      document({run("icd", 0.1, 0.01, 5, 0.01), run("yarn_projection", 0.1, 0.01, 4, 0.01),
                run("icd", 0.01, 0.02, 3, 0.01), run("yarn_projection", 0.01, 0.02, 1, 0.06)});
  const auto planes = planes_of(result);
  ASSERT_EQ(planes.size(), 1U);
  const Cell& cell = planes[0].cell(0.1, 0.02);
  EXPECT_EQ(winner(cell), "chain/icd/n:80/strain:0.01/h:0.02");
  ASSERT_EQ(cell.entries.size(), 2U) << "one of each contestant";
  EXPECT_EQ(cell.counting(1)->point.id(), "chain/yarn_projection/n:80/strain:0.1/h:0.01");
  EXPECT_EQ(winner(planes[0].cell(0.1, any_motion)),
            "chain/yarn_projection/n:80/strain:0.01/h:0.02");
  EXPECT_EQ(winner(planes[0].cell(0.01, 0.02)), "chain/icd/n:80/strain:0.01/h:0.02");
}

TEST(Plane, ComparesWithTheMethodsThatThePaperHas) {
  for (const auto& backend : backends()) {
    if (std::string(backend.name) != backend.method) continue;  // in another stepper
    const bool named = std::ranges::any_of(all_paper_methods, [&](const PaperMethod& method) {
      return method.name == std::string(backend.name);
    });
    EXPECT_EQ(named, backend.origin == inextensible::Origin::paper) << backend.name;
  }
}

TEST(Findings, NameTheFirstItsPriceAndTheBestOfThePaper) {
  json failed = run("yarn_projection", 0.01, 0.01, 0.05, 0.3);
  failed["status"] = "diverged";
  const struct {
    std::vector<json> runs;
    const char* sentence;  // or a part of it
  } cases[] = {
      {{run("yarn_projection", 0.01, 0.01, 0.05, 0.014), run("icd", 0.01, 0.005, 0.2, 0.01),
        run("shake", 0.01, 0.01, 0.1, 0.012)},
       "At 1 % strain, motion error at most 2 %, yarn_projection is the fastest: 50 ms a simulated "
       "second with steps of 1/100 s and an error of 1.4 %; shake, the best of the paper's six, "
       "takes 2.00 (1.99-2.01) times as long."},
      {{run("yarn_projection", 0.01, 0.01, 0.0500, 0.01), run("icd", 0.01, 0.01, 0.0501, 0.01),
        run("shake", 0.01, 0.01, 0.1, 0.01)},
       "yarn_projection and icd are the fastest, too close to rank: 50 ms a simulated second with "
       "steps of 1/100 s and an error of 1 %; shake, the next, takes 2.0"},
      // No run has an error of at most 2 %: the nearest looser level is answered.
      {{run("yarn_projection", 0.01, 0.01, 0.05, 0.04), run("icd", 0.01, 0.01, 0.1, 0.3)},
       "At 1 % strain, motion error at most 5 %, only yarn_projection has a run"},
      {{run("yarn_projection", 0.01, 0.01, 0.05, 0.3)}, "At 1 % strain, whatever the motion, "},
      {{failed},
       "At 1 % strain, whatever the motion, there is no answer: no run keeps the strain limit."}};
  for (const auto& [runs, sentence] : cases) {
    const auto findings = findings_of(planes_of(document(runs)));
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_NE(findings[0].sentences.at(0).find(sentence), std::string::npos)
        << findings[0].sentences[0];
  }
}

}  // namespace
}  // namespace harness::analysis
