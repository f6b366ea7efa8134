// The hard cases: the judge sees what it is there to see, and the outcomes that theory fixes.
#include "harness/stability/stability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "harness/stability/case_parts.h"
#include "harness/stability/trial_judge.h"

namespace {

using harness::HardCase;
using harness::Outcome;
using harness::Trial;
using harness::TrialJudge;
using harness::TrialResult;
using inextensible::State;

// Two free vertices of 1 kg, 1 m apart along x, without gravity, turning about their middle.
Trial dumbbell(bool pinned) {
  inextensible::ProblemParts parts;
  parts.mass = {1, 1};
  parts.edges = {{0, 1}};
  parts.rest_length = {1};
  parts.gravity.setZero();
  if (pinned) parts.pinned = {0};
  Trial trial;
  trial.scene.start.x.setZero(3, 2);
  trial.scene.start.x(0, 1) = 1;
  trial.scene.start.v.setZero(3, 2);
  trial.scene.start.v(1, 0) = pinned ? 0 : -1;
  trial.scene.start.v(1, 1) = 1;
  trial.scene.problem = std::make_shared<const inextensible::Problem>(std::move(parts));
  trial.step = 0.01;
  return trial;
}

class TrialJudgeTest : public testing::Test {
 protected:
  std::optional<Outcome> judge(const Trial& trial, const State& after, bool limit_promised = true) {
    TrialJudge judge(trial, *inextensible::find_backend(limit_promised ? "shake" : "null"));
    judge.before(trial.scene.start);
    const auto outcome = judge.after(after.x, after, trial.step, result_);
    return outcome ? outcome : judge.finish(result_);
  }
  TrialResult result_;
};

TEST_F(TrialJudgeTest, AcceptsTheStateThatItStartedFrom) {
  for (const bool pinned : {false, true}) {
    const Trial trial = dumbbell(pinned);
    EXPECT_EQ(judge(trial, trial.scene.start), std::nullopt) << result_.detail;
    EXPECT_EQ(result_.max_strain, 0);
    EXPECT_EQ(result_.energy_gain, 0);
  }
}

TEST_F(TrialJudgeTest, SeesAStateThatIsNotFinite) {
  const Trial trial = dumbbell(false);
  State state = trial.scene.start;
  state.v(2, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(judge(trial, state), Outcome::wrong);
}

TEST_F(TrialJudgeTest, SeesAMissedLimitOnlyWhereOneWasPromised) {
  const Trial trial = dumbbell(false);
  State state = trial.scene.start;
  state.x(0, 1) += 0.0101;
  EXPECT_EQ(judge(trial, state), Outcome::wrong);
  EXPECT_NE(result_.detail.find("edge 0"), std::string::npos);
  EXPECT_EQ(judge(trial, state, false), std::nullopt);
  EXPECT_NEAR(result_.max_strain, 0.0101, 1e-12);
}

TEST_F(TrialJudgeTest, SeesDivergence) {
  const Trial trial = dumbbell(false);
  State state = trial.scene.start;
  state.x(0, 1) = 12;
  EXPECT_EQ(judge(trial, state, false), Outcome::diverged);
}

TEST_F(TrialJudgeTest, SeesAPinThatMovedByOneBit) {
  const Trial trial = dumbbell(true);
  State state = trial.scene.start;
  state.x(1, 0) = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(judge(trial, state), Outcome::wrong);
  EXPECT_NE(result_.detail.find("pinned vertex 0"), std::string::npos);
}

TEST_F(TrialJudgeTest, SeesMomentumOutOfNothing) {
  const Trial trial = dumbbell(false);
  State state = trial.scene.start;
  state.v(0, 0) += 1e-6;
  EXPECT_EQ(judge(trial, state), Outcome::wrong);
  EXPECT_NE(result_.detail.find("momentum"), std::string::npos);
}

TEST_F(TrialJudgeTest, SeesEnergyBeyondToleranceAndSlack) {
  Trial trial = dumbbell(true);  // 1/2 J, which is its scale
  State state = trial.scene.start;
  state.v(1, 1) = std::sqrt(1.04);
  EXPECT_EQ(judge(trial, state), std::nullopt);
  EXPECT_NEAR(result_.energy_gain, 0.04, 1e-12);
  state.v(1, 1) = std::sqrt(1.06);
  EXPECT_EQ(judge(trial, state), Outcome::wrong);
  trial.slack = 1e-3;  // M (1.5 slack / h)^2 / 2 = 0.0225 J = 0.045 of the scale
  EXPECT_EQ(judge(trial, state), std::nullopt);
  trial.energy_tolerance = -1;
  state.v(1, 1) = 100;
  EXPECT_EQ(judge(trial, state), std::nullopt);
}

const HardCase& named(const std::vector<HardCase>& cases, const std::string& name) {
  return *std::find_if(cases.begin(), cases.end(), [&](const auto& c) { return c.name == name; });
}

TEST(HardCases, HaveUniqueNamesAndAnExpectationForEverySolver) {
  std::set<std::string> names;
  for (const HardCase& c : harness::hard_cases(harness::hard_case_values("paper"))) {
    EXPECT_TRUE(names.insert(c.name).second) << c.name << " twice";
    for (const auto& backend : inextensible::backends()) {
      if (!backend.contestant) continue;
      EXPECT_TRUE(std::any_of(c.expectations.begin(), c.expectations.end(),
                              [&](const auto& e) { return e.solvers.contains(backend.name); }))
          << c.name << ", " << backend.name;
    }
    EXPECT_TRUE(c.expectations.back().solvers.everyone()) << c.name;  // solvers from outside
    for (const auto& e : c.expectations) {
      EXPECT_NE(e.why, "") << c.name;
      if (e.other) {
        EXPECT_NE(e.other->outcome, e.outcome) << c.name;
        EXPECT_NE(e.other->why, "") << c.name;
      }
      for (const std::string& name : e.solvers.names()) {  // "@bdf2": of a stepper
        const std::string solver = name.starts_with('@') ? "fast_projection" + name : name;
        EXPECT_NE(inextensible::find_backend(solver), nullptr) << solver;
      }
    }
  }
}

TEST(HardCases, ExpectARefusalOfContactWhereNoObstacleIsTaken) {
  for (const HardCase& c : harness::hard_cases(harness::hard_case_values("quick"))) {
    if (c.row != "contact") continue;
    for (const auto& backend : inextensible::backends()) {
      const auto e = std::find_if(c.expectations.begin(), c.expectations.end(),
                                  [&](const auto& x) { return x.solvers.contains(backend.name); });
      ASSERT_NE(e, c.expectations.end());
      EXPECT_EQ(e->outcome, backend.takes_collider ? Outcome::survived : Outcome::refused)
          << c.name << ", " << backend.name;
    }
  }
}

TEST(KnownDifferences, AreOfCasesAndSolversThatExistAndDifferFromWhatIsExpected) {
  const auto cases = harness::hard_cases(harness::hard_case_values("paper"));
  for (const harness::KnownDifference& known : harness::known_differences()) {
    const auto c = std::find_if(cases.begin(), cases.end(),
                                [&](const auto& hard) { return hard.name == known.hard_case; });
    ASSERT_NE(c, cases.end()) << known.hard_case;
    ASSERT_NE(inextensible::find_backend(known.solver), nullptr) << known.solver;
    EXPECT_STRNE(known.reason, "") << known.hard_case;
    EXPECT_STRNE(known.mends, "") << known.hard_case;
    const auto e = std::find_if(c->expectations.begin(), c->expectations.end(),
                                [&](const auto& x) { return x.solvers.contains(known.solver); });
    TrialResult result;
    result.fixed = known.fixed;
    result.outcome = known.outcome;
    EXPECT_FALSE(harness::acceptable(*e, known.solver, result)) << known.hard_case;
    EXPECT_EQ(harness::known_difference(known.hard_case, known.solver, result), &known);
  }
  EXPECT_EQ(harness::known_difference("Q1", "icd", {}), nullptr);
}

// Barth et al. 1994, Goldenthal et al. 2007, Figure 2.
TEST(HardCases, ShakeRefusesQ1AndQ4AndCurrentDirectionsDoNot) {
  const auto cases = harness::hard_cases(harness::hard_case_values("quick"));
  for (const char* q : {"Q1", "Q4"}) {
    EXPECT_EQ(harness::run_trial(named(cases, q).build, "shake", 1).fixed, Outcome::refused) << q;
    for (const char* solver : {"fast_projection", "fast_projection@bdf2", "icd"})
      EXPECT_EQ(harness::run_trial(named(cases, q).build, solver, 1).fixed, Outcome::survived)
          << q << ", " << solver;
  }
}

TEST(HardCases, ImpossibleNumbersAreRefusedAtTheDoorAndNamed) {
  for (const HardCase& c : harness::hard_cases(harness::hard_case_values("quick"))) {
    if (!c.name.starts_with("door/")) continue;
    const TrialResult result = harness::run_trial(c.build, "fast_projection", 1);
    EXPECT_EQ(result.outcome, Outcome::refused) << c.name;
    EXPECT_TRUE(result.detail.find("at the door: vertex ") != std::string::npos ||
                result.detail.find("at the door: edge ") != std::string::npos)
        << c.name << ": " << result.detail;
  }
}

TEST(HardCases, NothingSatisfiesTheInfeasibleAndTheWorstEdgeIsNamed) {
  const auto cases = harness::hard_cases(harness::hard_case_values("quick"));
  for (const char* name : {"infeasible/row", "infeasible/duplicate"}) {
    for (const char* solver : {"fast_projection", "icd", "shake", "gauss_seidel", "jacobi"}) {
      const TrialResult result = harness::run_trial(named(cases, name).build, solver, 1);
      EXPECT_EQ(result.outcome, Outcome::refused) << name << ", " << solver;
      EXPECT_NE(result.detail.find("edge "), std::string::npos) << result.detail;
    }
  }
}

// Quads: 3 n^2 - 2 n (n - 1). Triangles with one diagonal: 3 n^2 - 2 n (n - 1) - (n - 1)^2.
TEST(DegreesOfFreedom, AreThoseOfAFullRankJacobian) {
  for (const int n : {3, 8, 15}) {
    const auto freedom = harness::degrees_of_freedom(n);
    ASSERT_EQ(freedom.size(), 3u);
    EXPECT_EQ(freedom[0].degrees_of_freedom, n * n + 2 * n);
    EXPECT_EQ(freedom[1].degrees_of_freedom, 4 * n - 1);
    // Three coordinates for each edge, three constraints for each triangle, all independent.
    const int edges = (n - 1) * (3 * n - 1), triangles = 2 * (n - 1) * (n - 1);
    EXPECT_EQ(freedom[2].constraints, 3 * triangles);
    EXPECT_EQ(freedom[2].degrees_of_freedom, 3 * edges - 3 * triangles);
  }
}

TEST(Stability, AFilteredSweepRunsJudgesAndPrints) {
  const auto cases = harness::hard_cases(harness::hard_case_values("quick"));
  harness::StabilityFilters filters;
  filters.solver = harness::Pattern("--solver", "shake|icd");
  filters.hard_case = harness::Pattern("--case", "^Q[14]$");
  const auto outcome = harness::run_stability(plan_stability(cases, filters), 1, {});
  EXPECT_EQ(outcome.cells.size(), 4u);
  EXPECT_TRUE(outcome.complete);
  EXPECT_EQ(outcome.counts().not_as_expected, 0);
  EXPECT_EQ(outcome.counts().strict, 3);  // of ICD's Q4 theory cannot say
  EXPECT_TRUE(outcome.nothing_new());
  std::ostringstream text;
  harness::print_stability(text, outcome);
  EXPECT_NE(text.str().find("Q4"), std::string::npos);
  std::ostringstream narrow;
  harness::print_stability(narrow, outcome, 40);  // a table below the other
  std::istringstream lines(narrow.str());
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 40u) << line;
  EXPECT_NE(text.str().find("4 cells: 3 with one expected outcome, 1 that admit two; not as "
                            "expected: 0, of them 0 not known"),
            std::string::npos)
      << text.str();
}

// A difference that the table does not have fails the sweep.
TEST(Stability, ANewDifferenceIsTold) {
  auto cases = harness::hard_cases(harness::hard_case_values("quick"));
  HardCase& q1 = const_cast<HardCase&>(named(cases, "Q1"));
  q1.expectations = {{{}, Outcome::refused, "nobody can, for once"}};
  harness::StabilityFilters filters;
  filters.solver = harness::Pattern("--solver", "fast_projection");
  filters.hard_case = harness::Pattern("--case", "^Q1$");
  const auto outcome = harness::run_stability(plan_stability(cases, filters), 1, {});
  EXPECT_EQ(outcome.counts().not_as_expected, 1);
  EXPECT_EQ(outcome.counts().new_differences, 1);
  EXPECT_FALSE(outcome.nothing_new());
  std::ostringstream text;
  harness::print_stability(text, outcome);
  EXPECT_NE(text.str().find("NEW: Q1, fast_projection: survived, expected refused"),
            std::string::npos)
      << text.str();
}

// Two rigid links without gravity turn for ever: strain, which a step that follows the tangent
// makes, is the same in the first and in the last second, and nothing is told of shorter trials.
TEST(Stability, StrainIsKeptOfTheFirstAndTheLastSecond) {
  for (const int steps : {150, 250}) {
    const TrialResult result = harness::run_trial(
        [steps] {
          Trial trial = dumbbell(true);
          trial.steps = steps;
          trial.strain_limit = 1e-6;
          return trial;
        },
        "icd", 1);
    ASSERT_EQ(result.outcome, Outcome::survived) << result.detail;
    if (steps < 200) {
      EXPECT_TRUE(std::isnan(result.strain_first_second));
      EXPECT_TRUE(std::isnan(result.strain_last_second));
    } else {
      EXPECT_GT(result.strain_first_second, 0);
      EXPECT_NEAR(result.strain_last_second, result.strain_first_second, 1e-6);
      EXPECT_LE(result.strain_last_second, result.max_strain);
    }
  }
}

// Frames of the same solver from a start that was hardly moved are that close before contact, and
// ICD is within the slack of the limit.
TEST(SameFrame, RunsAgreeBeforeContactAndAreComparedAfterIt) {
  const harness::SameFrameScene scene{"drape", 9, 0.01, 1.0 / 200, 1e-10};
  harness::ReferenceFolder none("no folder");
  const auto found = harness::same_frame(scene, 1, none);
  EXPECT_EQ(found.stopped, "");
  EXPECT_GT(found.first_contact, 0.01);  // 1 mm above the sphere
  EXPECT_LT(found.first_contact, 0.03);
  ASSERT_EQ(found.times.size(), found.icd.size());
  ASSERT_EQ(found.times.size(), found.moved.size());
  EXPECT_NEAR(found.times.back(), 1, 1e-12);
  for (std::size_t i = 0; i < found.times.size(); ++i) {
    EXPECT_GE(found.icd[i].largest, found.icd[i].rms);
    if (found.times[i] >= found.first_contact) continue;
    EXPECT_GT(found.moved[i].rms, 1e-11);
    EXPECT_LT(found.moved[i].rms, 1e-9);
    EXPECT_LT(found.icd[i].rms, 0.01);
  }
  EXPECT_GT(found.icd.back().rms, 0);
  EXPECT_GT(found.icd.back().shape.kinetic_energy, 0);
  ASSERT_EQ(found.deviation.size(), found.times.size());
  EXPECT_TRUE(std::isnan(found.deviation.back().shadow));
}

}  // namespace
