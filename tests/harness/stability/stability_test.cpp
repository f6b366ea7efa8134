// The hard cases: the judge sees what it is there to see, and the outcomes that theory fixes.
#include "harness/stability/stability.h"

#include "support/motion.h"

namespace harness {
namespace {

// Two free vertices of 1 kg, 1 m apart along x, without gravity, turning about their middle.
Trial dumbbell(bool pinned) {
  Trial trial;
  trial.scene.problem =
      inextensible::testing::one_edge(1, 1, pinned ? std::vector<int>{0} : std::vector<int>{});
  trial.scene.start = inextensible::testing::stretched_edge(1);
  trial.scene.start.v(1, 0) = pinned ? 0 : -1;
  trial.scene.start.v(1, 1) = 1;
  trial.step = 0.01;
  return trial;
}

// What the judge makes of a step from the trial's start to a state.
TrialResult judged(const Trial& trial, const State& state, const char* solver = "shake") {
  TrialResult result;
  const auto stepper = make_stepper(solver, trial.scene.problem, {});
  TrialJudge judge(trial, *find_backend(solver), *stepper, result);
  State start = trial.scene.start;
  judge.before(start, {});
  judge.after(state.x, state, trial.step);
  result.outcome = judge.finish();
  return result;
}

// "null" promises no limit.
TEST(TrialJudge, SeesWhatOneStepBreaks) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const struct {
    bool pinned;
    const char* solver;
    std::function<void(State&)> change;
    Outcome outcome;
    const char* detail;
  } steps[] = {
      {false, "shake", [](State&) {}, Outcome::survived, ""},
      {true, "shake", [](State&) {}, Outcome::survived, ""},
      {false, "shake", [=](State& s) { s.v(2, 1) = nan; }, Outcome::wrong, "not finite"},
      {false, "shake", [](State& s) { s.x(0, 1) += 0.0101; }, Outcome::wrong, "edge 0"},
      {false, "null", [](State& s) { s.x(0, 1) += 0.0101; }, Outcome::survived, ""},
      {false, "null", [](State& s) { s.x(0, 1) = 12; }, Outcome::diverged, "strain"},
      {true, "shake", [](State& s) { s.x(1, 0) = 5e-324; }, Outcome::wrong, "pinned vertex 0"},
      {false, "shake", [](State& s) { s.v(0, 0) += 1e-6; }, Outcome::wrong, "momentum"}};
  for (const auto& step : steps) {
    const Trial trial = dumbbell(step.pinned);
    State state = trial.scene.start;
    step.change(state);
    const TrialResult result = judged(trial, state, step.solver);
    EXPECT_EQ(result.outcome, step.outcome) << step.detail;
    EXPECT_NE(result.detail.find(step.detail), std::string::npos) << result.detail;
    if (!std::isfinite(result.max_strain)) continue;
    EXPECT_NEAR(result.max_strain, (state.x.col(1) - state.x.col(0)).norm() - 1, 1e-12);
  }
}

TEST(TrialJudge, SeesEnergyBeyondToleranceAndSlack) {
  Trial trial = dumbbell(true);  // 1/2 J, which is its scale
  const auto gaining = [&trial](double energy) {
    State state = trial.scene.start;
    state.v(1, 1) = std::sqrt(1 + energy);
    return judged(trial, state);
  };
  EXPECT_EQ(gaining(0.04).outcome, Outcome::survived);
  EXPECT_NEAR(gaining(0.04).energy_gain, 0.04, 1e-12);
  EXPECT_EQ(gaining(0.06).outcome, Outcome::wrong);
  trial.slack = 1e-3;  // M (1.5 slack / h)^2 / 2 = 0.0225 J = 0.045 of the scale
  EXPECT_EQ(gaining(0.06).outcome, Outcome::survived);
  trial.energy_tolerance = -1;
  EXPECT_EQ(gaining(1e4).outcome, Outcome::survived);
}

TEST(HardCases, HaveUniqueNamesAndReasonedExpectationsAboutSolversThatExist) {
  std::set<std::string> names;
  for (const HardCase& c : hard_cases("paper")) {
    EXPECT_TRUE(names.insert(c.name).second) << c.name << " twice";
    ASSERT_TRUE(!c.expectations.empty() && c.expectations.back().solvers.empty()) << c.name;
    for (const auto& e : c.expectations) {
      EXPECT_FALSE(e.other && e.other->outcome == e.outcome) << c.name;
      for (const std::string& word : e.solvers)
        EXPECT_TRUE(std::ranges::any_of(backends(), [one = Expectation{{word}, e.outcome, ""}](
                                                        const auto& b) { return one.about(b); }))
            << c.name << ": " << word;
    }
  }
}

TEST(KnownDifferences, AreOfCasesAndSolversThatExistAndDifferFromWhatIsExpected) {
  const auto cases = hard_cases("paper");
  for (const KnownDifference& known : known_differences()) {
    ASSERT_NE(find_backend(known.solver), nullptr) << known.solver;
    for (const std::string& name : known.hard_cases) {
      const auto hard_case = std::ranges::find(cases, name, &HardCase::name);
      ASSERT_NE(hard_case, cases.end()) << name;
      TrialResult result;
      result.fixed = known.fixed;
      result.outcome = known.outcome;
      EXPECT_FALSE(acceptable(hard_case->expectation(known.solver), known.solver, result)) << name;
      EXPECT_EQ(known_difference(name, known.solver, result), &known);
    }
  }
  EXPECT_EQ(known_difference("Q1", "icd", {}), nullptr);
}

// Quads: 3 n^2 - 2 n (n - 1). Triangles with one diagonal: 3 n^2 - 2 n (n - 1) - (n - 1)^2.
TEST(DegreesOfFreedom, AreThoseOfAFullRankJacobian) {
  for (const int n : {3, 8, 15}) {
    const auto freedom = degrees_of_freedom(n);
    ASSERT_EQ(freedom.size(), 3u);
    EXPECT_EQ(freedom[0].degrees_of_freedom, n * n + 2 * n);
    EXPECT_EQ(freedom[1].degrees_of_freedom, 4 * n - 1);
    // Three coordinates for each edge, three constraints for each triangle, all independent.
    const int edges = (n - 1) * (3 * n - 1), triangles = 2 * (n - 1) * (n - 1);
    EXPECT_EQ(freedom[2].constraints, 3 * triangles);
    EXPECT_EQ(freedom[2].degrees_of_freedom, 3 * edges - 3 * triangles);
  }
}

// A difference that the table does not have fails the sweep.
TEST(Stability, ANewDifferenceIsTold) {
  auto plan =
      plan_stability("quick", Pattern("--solver", "shake|icd"), Pattern("--case", "^(Q1|Q4)$"));
  auto outcome = run_stability(plan, 1, {});
  ASSERT_EQ(outcome.cells.size(), 4u);
  EXPECT_TRUE(outcome.complete);
  EXPECT_EQ(outcome.counts().new_differences, 0);
  EXPECT_EQ(outcome.counts().strict, 3);  // of ICD's Q4 theory cannot say
  plan.cases[0].expectations = {{{}, Outcome::refused, "nobody can, for once"}};
  outcome = run_stability(plan, 1, {});
  EXPECT_EQ(outcome.counts().new_differences, 1);
}

// Two rigid links without gravity turn for ever: strain, which a step that follows the tangent
// makes, is the same in the first and in the last second, and nothing is told of shorter trials.
TEST(Stability, StrainIsKeptOfTheFirstAndTheLastSecond) {
  for (const int steps : {150, 250}) {
    Trial trial = dumbbell(true);
    trial.steps = steps;
    trial.strain_limit = 1e-6;
    const TrialResult result = run_trial([&trial] { return trial; }, "icd", 1);
    ASSERT_EQ(result.outcome, Outcome::survived) << result.detail;
    EXPECT_EQ(std::isnan(result.strain_first_second), steps < 200);
    EXPECT_EQ(std::isnan(result.strain_last_second), steps < 200);
    if (steps < 200) continue;
    EXPECT_GT(result.strain_first_second, 0);
    EXPECT_NEAR(result.strain_last_second, result.strain_first_second, 1e-6);
    EXPECT_LE(result.strain_last_second, result.max_strain);
  }
}

// Before contact ICD is within the limit's slack.
TEST(SameFrame, RunsAgreeBeforeContactAndAreComparedAfterIt) {
  const auto found = same_frame({"drape", 9, 0.01}, 1);
  EXPECT_EQ(found.stopped, "");
  EXPECT_GT(found.first_contact, 0.01);  // 1 mm above the sphere
  EXPECT_LT(found.first_contact, 0.03);
  const auto& icd = found.icd.rms;
  ASSERT_EQ(found.times.size(), icd.size());
  EXPECT_NEAR(found.times.back(), 1, 1e-12);
  for (std::size_t i = 0; i < found.times.size(); ++i) {
    EXPECT_GE(found.icd.largest[i], icd[i]);
    EXPECT_TRUE(found.times[i] >= found.first_contact || icd[i] < 0.01) << found.times[i];
  }
  EXPECT_GT(icd.back(), 0);
}

}  // namespace
}  // namespace harness
